// How an image's rays are spared most surfaces, in words and as JSON.
#pragma once

#include <string>

#include "backlight/trace/trace_strategy.h"

namespace backlight {

/// The lines "rays" and "shadows" of `check`. Lights that are treated alike share a line.
std::string strategy_lines(const Scene& scene, const TraceStrategy& strategy);

/// The line "reuse" of `check`: what an image takes over from the one before, unchanged.
std::string reuse_line(const CompileCounts& counts);

/// ["light-sky cones per tile: 200 surfaces","none"]: the shadow rays of each light, in the order of the
/// scene.
std::string shadows_json(const TraceStrategy& strategy);

}  // namespace backlight
