// What an image tells of one pixel.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/base/vector.h"
#include "backlight/film/exr.h"

namespace backlight {

/// A pixel of the whole image, from the top left.
struct PixelPlace {
  int x = 0;
  int y = 0;
};

/// One pixel's channels, and what follows from them and the header. What the file does not tell is empty.
struct PixelFacts {
  std::vector<std::pair<std::string, float>> channels;  ///< all of them, as in the file
  std::optional<Vec3> colour;                           ///< scene-linear film colour
  std::optional<float> alpha;
  bool is_sky = false;                ///< its centre meets nothing, by objectId or Z
  std::optional<int> object_id;       ///< 0: none
  std::optional<std::string> object;  ///< its name; empty: it has none in the scene
  std::optional<float> distance, doppler, emission_time, proper_time;
  std::optional<double> camera_time;  ///< when the light left, by clocks at rest to the camera: seconds
  std::optional<Vec3> position, normal;

  // In the camera's frame, degrees and scene units.
  std::optional<double> from_axis;           ///< angle between the ray through the centre and the view axis
  std::optional<double> from_camera_motion;  ///< and the camera's velocity, if it moves in the world
  std::optional<double> from_object_motion;  ///< and the object's velocity, if that is one and not zero
  std::optional<Vec3> object_velocity;
  bool matter_moves = false;  ///< it has none that is the same everywhere
  double c = 1.0;             ///< of the scene, for velocities

  std::vector<std::string> missing;  ///< words for --aov that would tell what is empty here
};

/// Reads pixels of a file, a row at a time.
class PixelProbe {
 public:
  /// `view`: 0 left, or the only one; 1 right. Fails on a file that cannot be read or has no such view.
  static Result<PixelProbe> open(const std::filesystem::path& file, std::size_t view);

  /// Why the file does not have this pixel: it is outside of the image or its crop; or empty.
  [[nodiscard]] std::string absence(const PixelPlace& place) const;

  /// The pixel, which must not be absent; nothing if this partial image has not rendered it yet.
  Result<std::optional<PixelFacts>> facts(const PixelPlace& place);

 private:
  PixelProbe(ExrReader reader, std::size_t view) : reader_(std::move(reader)), view_(view) {}
  void add_angles(const PixelPlace& place, PixelFacts& facts) const;
  void add_object(PixelFacts& facts) const;

  ExrReader reader_;
  std::size_t view_;
};

}  // namespace backlight
