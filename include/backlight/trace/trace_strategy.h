// How an image's rays are spared most of the surfaces: chosen by counts, and told in words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "backlight/scene/scene.h"

namespace backlight {

/// One way of finding out which surfaces some rays have to ask. No choice changes a bit of the image.
struct CullingChoice {
  std::string method;         ///< "light-sky cones per tile"...; empty where nothing is asked
  std::size_t surfaces = 0;   ///< with a cone of their own on that sky
  std::size_t trees = 0;      ///< frames whose surfaces are one tree of boxes
  std::size_t unbounded = 0;  ///< planes and the like, which all rays ask
};

/// The choices of one image. They follow from the scene alone: the same on every machine.
struct TraceStrategy {
  std::string rays;                    ///< "sheets of 64 rays" or "one ray at a time"
  CullingChoice camera;                ///< of camera rays
  std::vector<CullingChoice> shadows;  ///< of shadow rays, by light, in the order of the scene's
};

/// What the tracer will do. The thresholds are those of src/trace/culling.h, with the measurements that they
/// come from.
TraceStrategy trace_strategy(const Scene& scene);

/// "light-sky cones per tile: 200 surfaces, 1 tree, 1 unbounded".
std::string in_words(const CullingChoice& choice);

}  // namespace backlight
