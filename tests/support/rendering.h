// Whole images rendered in the test's own process, and what tests ask of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "backlight/render/render.h"

namespace backlight::test {

struct Rendering {
  Scene scene;
  Image image;
  RenderStatistics statistics;

  [[nodiscard]] int width() const { return image.layout().display.width(); }
  [[nodiscard]] int height() const { return image.layout().display.height(); }
  /// The value of a channel, by its name in the file; fails the test when there is no such channel.
  [[nodiscard]] double at(const char* channel, int x, int y) const;
  [[nodiscard]] int id(int x, int y) const { return static_cast<int>(at("objectId.V", x, y)); }
  [[nodiscard]] Vec3 rgb(int x, int y) const { return {at("R", x, y), at("G", x, y), at("B", x, y)}; }
  [[nodiscard]] Vec3 position(int x, int y) const {
    return {at("P.X", x, y), at("P.Y", x, y), at("P.Z", x, y)};
  }
  [[nodiscard]] Vec3 normal(int x, int y) const {
    return {at("N.X", x, y), at("N.Y", x, y), at("N.Z", x, y)};
  }
  /// The unit looking direction of a pixel's centre, camera frame.
  [[nodiscard]] Vec3 direction(int x, int y) const;
  /// Whether all eight neighbours show the same object.
  [[nodiscard]] bool is_inside(int x, int y) const;
};

struct RenderChoices {
  int threads = 2;
  std::optional<PixelBox> crop;
  std::optional<int> wavelengths;  ///< instead of what the scene needs
  std::optional<double> time;
  std::optional<int> frame;  ///< number of the image in its animation
  std::vector<std::string> overrides;
  RayPath path = RayPath::sheets;
  InstructionSet instructions = InstructionSet::widest;
  ModelPieces pieces;
};

/// Renders a scene given as text. Throws std::runtime_error with the diagnostics when it is wrong.
Rendering render_text(const std::string& text, const RenderChoices& choices = {});

/// Renders images of an animation given as text one after the other, as a run of the program does: they share
/// what they can.
std::vector<Rendering> render_sequence(const std::string& text, const std::vector<int>& frames);

/// Renders a scene file of the project's scenes/ or tests/ folder, by its path from the project's root.
Rendering render_file(const std::string& path, const RenderChoices& choices = {});

/// "[film] resolution = [w, h]" with one sample and every data channel.
std::string film(int width, int height);

}  // namespace backlight::test
