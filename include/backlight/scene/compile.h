// From a description to the scene as it is true at one image.
#pragma once

#include <memory>
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
  /// To be told of and not rendered: of a lattice with very many copies only the first are made, the others
  /// counted (SceneFrame::left_out).
  bool outline = false;
};

struct CompiledParts;

/// Compiles the images of one description, which share what does not depend on t: materials, stars, and the
/// surfaces of a frame with their search tree, whatever the frame itself does. Whether something depends on t
/// is read off its formulas. A scene is the same, bit for bit, as if it had been compiled alone.
class SceneCompiler {
 public:
  /// How many images there will be: of one alone, nothing is kept for others.
  enum class Images { one, several };

  /// The description and the cache must outlive this.
  SceneCompiler(const Description& description, ResourceCache& cache, Images images);
  ~SceneCompiler();
  SceneCompiler(const SceneCompiler&) = delete;
  SceneCompiler& operator=(const SceneCompiler&) = delete;

  /// Evaluates every number for one image, composes the frames, loads what other files hold and builds the
  /// surfaces. Adds what is wrong to `diagnostics`; returns a scene only if they hold no error, those of
  /// reading included. For use by one thread; the scenes may be used by others meanwhile.
  ///
  /// t = (frame - 1)/fps; without [animation] t = 0. With an explicit time, `frame` is t fps + 1 in an
  /// animation and 1 without.
  std::optional<Scene> compile(const ImageRequest& request, Diagnostics& diagnostics);

 private:
  void forget();

  const Description& description_;
  ResourceCache& cache_;
  Images images_;
  std::unique_ptr<CompiledParts> parts_;
};

/// The same for one image alone.
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
