// The pixels of one view of an image, a tile at a time.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "backlight/camera/sampling.h"
#include "backlight/render/adaptive_sampling.h"
#include "backlight/render/render.h"
#include "channels.h"
#include "pixel_blocks.h"

namespace backlight {

// What one thread works with.
struct ThreadMemory {
  ThreadMemory(const Tracer& tracer, const SheetTracer* sheets, InstructionSet set)
      : scratch(tracer.make_scratch(set)), sheet(nullptr, nullptr) {
    if (sheets != nullptr) sheet = sheets->make_scratch();
  }

  Scratch scratch;
  std::unique_ptr<SheetScratch, void (*)(SheetScratch*)> sheet;
  TileLight light;
  // Of the tile in hand:
  PixelBox window;                    // of its band of rows
  std::uint8_t* done = nullptr;       // there, by pixel
  std::optional<PixelWriter> writer;  // into that band
  MissingPixels missing;
  std::vector<LinearRgb> sums;
  std::vector<ImagePoint> centres;  // of pixels
  std::vector<int> covered;
  std::vector<double> lamp_times;          // of one pixel
  std::optional<AdaptiveSampler> sampler;  // where the number of samples is chosen
  SampleCounts samples;
  double seconds = 0.0;  // in tiles
};

// The pixels of one view: what a tile task needs.
class ViewRenderer {
 public:
  ViewRenderer(const Tracer& tracer, const SheetTracer* sheets, const RenderSettings& settings, int eye,
               std::size_t view)
      : tracer_(tracer),
        sheets_(sheets),
        settings_(settings),
        eye_(eye),
        view_(view),
        has_stars_(tracer.has_stars()),
        has_data_(has_data_channels(tracer.scene())) {
    if (tracer.scene().film.adaptive) small_things_ = small_things(tracer.scene(), tracer.hub(), eye);
  }

  // How the pixels get their samples where a tolerance is asked for. Takes what it needs to know: rays.
  SamplingPlan plan(ThreadMemory& memory) const;

  // Traces what is missing of a tile, which lies in the band; gives up between two pixels, or two samples of
  // the tile, when `stop` turns true and the tile is not about to be done: one of many samples may take
  // minutes.
  void tile(const PixelBox& box, RowBand& band, const std::atomic<bool>& stop, ThreadMemory& memory) const;

 private:
  // What goes wrong in `work` is told with the pixel that it was for.
  template <class Work>
  static void at_pixel(int x, int y, const Work& work) {
    try {
      work();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw PixelFailure(x, y, error.what());
    }
  }

  // As many samples of each missing pixel as it needs.
  void tile_to_tolerance(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) const;

  void trace_points(std::span<const ImagePoint> points, ThreadMemory& m,
                    std::vector<PixelSample>& samples) const;

  void trace_point(const ImagePoint& point, Scratch& scratch, PixelSample& sample) const;

  // Writes the pixels of m.missing, and that they are done. `estimate(k)`: the colour of one; `records`: what
  // each of them sees, where that is known.
  template <class Estimate>
  void write_all(ThreadMemory& m, const std::vector<SurfaceRecord>* records, const Estimate& estimate) const;

  // The same for one sample of each and no other channel than its colour.
  void write_colours(ThreadMemory& m) const;

  void trace_missing(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) const;

  // The same as pixel(), for all at once.
  void tile_in_sheets(const PixelBox& box, const std::atomic<bool>& stop, ThreadMemory& m) const;

  const std::vector<SurfaceRecord>* centres(ThreadMemory& m) const;

  void pixel(int x, int y, ThreadMemory& m) const;

  // The data channels, of which `known` is what the pixel sees where it is not null. Whether all are finite.
  bool data(int x, int y, const SurfaceRecord* known, int samples, ThreadMemory& m) const;

  const Tracer& tracer_;
  const SheetTracer* sheets_;  // null: one ray at a time
  const RenderSettings& settings_;
  int eye_;
  std::size_t view_;
  bool has_stars_;
  bool has_data_;
  std::vector<SmallThing> small_things_;  // where the number of samples is chosen
};

}  // namespace backlight
