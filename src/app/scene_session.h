// A scene file as a command uses it: read once, compiled for one image after the other.
#pragma once

#include <optional>
#include <vector>

#include "backlight/scene/compile.h"
#include "options.h"

namespace backlight {

class SceneSession {
 public:
  /// Reads the file. What is wrong with it is kept for the first compile().
  explicit SceneSession(const SceneOptions& options);

  /// To be called before the first compile(), if there will be no more than one: what is in the picture is
  /// then forgotten as soon as it is compiled. Who asks the description for its objects cannot say this.
  void expect_one_image() { images_ = SceneCompiler::Images::one; }

  /// exit_success while nothing is wrong; then compile() may be called.
  [[nodiscard]] int exit_code() const { return exit_code_; }

  /// The scene of one image, or nothing, with the errors printed. Warnings are printed by the first call
  /// alone.
  std::optional<Scene> compile(const ImageRequest& request);

  /// Whether the camera's path is below the speed of light between the images too; else the error is printed.
  bool check_camera_path(const ImageRequest& request);

  /// The frame numbers of the scene's [animation], or {1}.
  [[nodiscard]] std::vector<int> frames() const { return animation_frames(*description_); }
  [[nodiscard]] const Description& description() const { return *description_; }
  /// Of the files that the scene takes things from, once it has been compiled.
  Result<std::vector<std::string>> resource_digests() { return cache_.digests(); }

 private:
  void forget_contents();

  std::optional<Description> description_;
  Diagnostics found_by_reading_;
  ResourceCache cache_;
  SceneCompiler::Images images_ = SceneCompiler::Images::several;
  std::optional<SceneCompiler> compiler_;
  int exit_code_ = 0;
  bool warnings_are_printed_ = false;
};

}  // namespace backlight
