// Many rays at once: the same light as the Tracer's, bit for bit, sooner.
//
// The rays of a tile go together, as arrays. What each may meet is found for whole tiles, from the cones that
// moving things are on the camera's sky and on the lights' (docs/physics.md section 8); what is left is
// solved for several rays in one instruction. The Tracer is the law: one ray at a time, every object asked.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "backlight/trace/tracer.h"

namespace backlight {

struct TilePixel {
  int x = 0;  ///< of the full image
  int y = 0;
};

/// One sample of each pixel of a tile.
struct TileLight {
  std::array<std::vector<double>, 3> rgb;  ///< what Tracer::colour gives for its ray; 0 where there is none
  std::vector<std::uint8_t> covered;       ///< whether it is opaque (RayLight), for alpha
  std::vector<SurfaceRecord> record;       ///< what Tracer::surface gives, when asked for

  [[nodiscard]] LinearRgb colour(std::size_t pixel) const {
    return {rgb[0][pixel], rgb[1][pixel], rgb[2][pixel]};
  }
  void set_colour(std::size_t pixel, const LinearRgb& colour) {
    for (int k = 0; k < 3; ++k) rgb[static_cast<std::size_t>(k)][pixel] = colour[k];
  }
};

/// What is wanted of the rays of a tile.
struct TileAnswers {
  bool colours;
  bool records;
};

class SheetScene;
struct SheetScratch;

/// Traces tiles of one image. Immutable; each thread brings its own SheetScratch.
class SheetTracer {
 public:
  /// The tracer must outlive this.
  SheetTracer(const Tracer& tracer, InstructionSet set);
  ~SheetTracer();
  SheetTracer(const SheetTracer&) = delete;
  SheetTracer& operator=(const SheetTracer&) = delete;

  /// Whether this image's rays start from one event for each eye. (All around a stereo pair they do not, and
  /// are traced one by one.)
  [[nodiscard]] static bool can_trace(const Scene& scene);

  [[nodiscard]] std::unique_ptr<SheetScratch, void (*)(SheetScratch*)> make_scratch() const;

  /// Sample `sample` of every pixel, into `light`; counts into `scratch`.
  void trace(std::span<const TilePixel> pixels, std::int64_t image_number, int sample, int eye, bool records,
             SheetScratch& sheets, Scratch& scratch, TileLight& light) const;

  /// The light through any points of the image, neighbours next to one another, into `light`, in order.
  void trace(std::span<const ImagePoint> points, int eye, SheetScratch& sheets, Scratch& scratch,
             TileLight& light) const;

  /// What Tracer::surface gives for the rays through these points, into light.record alone.
  void surfaces(std::span<const ImagePoint> points, int eye, SheetScratch& sheets, Scratch& scratch,
                TileLight& light) const;

  /// The instruction set in use, by name.
  [[nodiscard]] const char* instructions() const;

 private:
  /// Returns how many of them the projection shows.
  std::size_t trace_sheets(std::size_t count, int eye, TileAnswers wanted, SheetScratch& sheets,
                           Scratch& scratch, TileLight& light) const;

  /// Adds the light of work.put_off.
  void pass_on(SheetScratch& work, Scratch& scratch, TileLight& light) const;

  const Tracer* tracer_;
  InstructionSet instructions_;
  std::unique_ptr<const SheetScene> scene_;
  std::vector<std::unique_ptr<const SheetScene>> relays_;  // by frame: as seen from those with mirrors
  std::vector<bool> relays_in_sheets_;                     // whose rays go in sheets
};

}  // namespace backlight
