// How many samples a pixel gets where an error is asked for instead of a number of samples.
//
// docs/command-line.md says what is promised; tests/laws/tolerance_test.cpp measures what is delivered.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/film/image.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

/// One sample of a pixel.
struct PixelSample {
  Vec3 colour{0.0};      ///< film colour; black where the projection shows nothing
  bool covered = false;  ///< whether it shows anything
  double x = 0.5;        ///< where in the pixel, 0 ... 1
  double y = 0.5;
};

/// Traces sample number `index` of all these pixels of the full image into `samples`, in order. Returns false
/// when it was stopped.
using TraceSamples =
    std::function<bool(std::span<const TilePixel> pixels, int index, std::vector<PixelSample>& samples)>;

/// What its samples say of a pixel.
struct PixelEstimate {
  Vec3 colour{0.0};       ///< the samples' mean
  double coverage = 0.0;  ///< share of the samples that the projection shows
  int samples = 0;        ///< how many there are
  bool at_limit = false;  ///< most_adaptive_samples were not enough for the error asked for
};

/// An estimate of the standard error of the samples' mean, for each channel in film units; the samples are
/// the first ones of a pixel. From their scatter within the cells of a grid that holds about three each:
/// where the scatter is that of an edge, few cells have any, and the estimate falls with n^(-3/4) as the
/// error does.
Vec3 standard_error(const std::vector<PixelSample>& samples);

/// Chooses the samples of a tile's pixels. One for each thread: it keeps its memory between tiles.
///
/// All pixels get a few first samples. One that looks the same as its eight neighbours is done; any other
/// gets more until the standard error of its mean is small enough. Nothing but the pixel and its neighbours
/// on the full image is looked at, and those outside the tile are traced again: the same bits for any tiles
/// and crop.
class AdaptiveSampler {
 public:
  /// `target`: the standard error that a pixel may have, on the scale of shown_value(); > 0.
  /// `picture`: the full image.
  AdaptiveSampler(double target, const PixelBox& picture);

  /// Estimates the pixels `wanted` of a tile, in order; returns false when it was stopped before the end.
  /// Throws what `trace` throws.
  bool tile(const PixelBox& tile, std::span<const TilePixel> wanted, const TraceSamples& trace);

  /// Those of the last tile.
  [[nodiscard]] const std::vector<PixelEstimate>& estimates() const { return estimates_; }

 private:
  struct Busy {
    std::size_t place = 0;  // in estimates_
    std::size_t wanted = 0;
    TilePixel pixel;
    std::vector<PixelSample> samples;
  };

  bool look(const PixelBox& tile, const TraceSamples& trace);
  bool refine(std::vector<Busy>& busy, const TraceSamples& trace);
  [[nodiscard]] double contrast(const TilePixel& pixel, const std::vector<PixelSample>& samples) const;
  [[nodiscard]] std::size_t looked(int x, int y) const;
  [[nodiscard]] bool is_enough(Busy& busy);
  [[nodiscard]] double error_of(const std::vector<PixelSample>& samples) const;

  double target_;
  PixelBox picture_;
  std::size_t first_count_;
  PixelBox box_;                                 // the tile and its border
  std::vector<std::vector<PixelSample>> first_;  // of each pixel of box_
  std::vector<Vec3> shown_;                      // their means on the scale of shown_value()
  std::vector<PixelEstimate> estimates_;
  std::vector<TilePixel> pixels_;      // working memory
  std::vector<PixelSample> together_;  // working memory
};

}  // namespace backlight
