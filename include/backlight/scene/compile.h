// From a description to the scene as it is true at one image.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/diagnostics.h"
#include "backlight/scene/description.h"
#include "backlight/scene/resources.h"
#include "backlight/scene/scene.h"

namespace backlight {

/// Which image, and what the command line says instead of the file. What is empty is taken from the file.
struct ImageRequest {
  std::optional<int> frame;    ///< of the animation; the first one by default
  std::optional<double> time;  ///< scene time in seconds, instead of a frame's
  std::string camera;          ///< name of a [[camera]]; the first one by default
  std::optional<std::pair<int, int>> resolution;
  std::optional<int> samples;
  std::optional<double> tolerance;  ///< replaces `samples` and `wavelengths` of the file too
  std::optional<int> wavelengths;
  std::optional<unsigned> seed;
  std::optional<std::vector<std::string>> aovs;
};

/// Evaluates every number for one image, composes the frames, loads what other files hold and builds the
/// surfaces. Adds what is wrong to `diagnostics`; returns a scene only if they hold no error, those of
/// reading included.
///
/// t = (frame - 1)/fps; without [animation] t = 0. With an explicit time, `frame` is t fps + 1 in an
/// animation and 1 without.
std::optional<Scene> compile(const Description& description, const ImageRequest& request,
                             ResourceCache& cache, Diagnostics& diagnostics);

/// What can be said of an image without compiling its scene.
struct ImageFacts {
  double time = 0.0;
  double frame = 1.0;
  std::string camera;  ///< the name of the camera that is used, if it has one
  FilmSettings film;
};

/// The facts as compile() would find them. Empty when something about them is wrong, which compile() reports.
std::optional<ImageFacts> image_facts(const Description& description, const ImageRequest& request);

/// Looks at the camera's path between the images of the animation too: adds an error that names the first
/// instant at which it is as fast as light, if there is one. For a description that compiles.
void check_camera_path(const Description& description, const ImageRequest& request, Diagnostics& diagnostics);

/// The frame numbers of [animation], or {1}. Empty if the table is wrong, which compile() reports.
std::vector<int> animation_frames(const Description& description);

}  // namespace backlight
