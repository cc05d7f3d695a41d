// One image of a scene, over tiles and threads.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "backlight/film/exr.h"
#include "backlight/film/image.h"
#include "backlight/render/partial_image.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

class ImageFile;
class ProgressReporter;

/// How the rays go: many at once, or one by one, every object asked: the law that all others obey to the last
/// bit. For tests and measurements.
enum class RayPath { sheets, one_by_one };

struct RenderSettings {
  int threads = 1;
  std::optional<PixelBox> crop;   ///< pixels of the full image; the EXR's data window
  int wavelengths = 0;            ///< of Needs: 0 = no colour is shifted
  std::int64_t image_number = 1;  ///< of the animation: the sample positions depend on it
  RayPath path = RayPath::sheets;
  InstructionSet instructions = InstructionSet::widest;  ///< of sheets
  ModelPieces pieces;  ///< without retarded shadows, rays go one by one. For measurements
};

/// The samples that the pixels got. (Those around a tile, which only help to choose, count as rays alone.)
struct SampleCounts {
  std::uint64_t pixels = 0;
  std::uint64_t total = 0;
  std::uint64_t least = 0;     ///< in any pixel
  std::uint64_t most = 0;      ///< in any pixel
  std::uint64_t at_limit = 0;  ///< pixels whose error may be larger than film.tolerance for all that

  void add(int samples, bool is_at_limit) {
    const auto count = static_cast<std::uint64_t>(samples);
    least = pixels == 0 || count < least ? count : least;
    most = count > most ? count : most;
    ++pixels;
    total += count;
    at_limit += is_at_limit ? 1 : 0;
  }
  SampleCounts& operator+=(const SampleCounts& other);
  /// Samples a pixel on average; 0 without pixels.
  [[nodiscard]] double mean() const { return pixels > 0 ? double(total) / double(pixels) : 0.0; }
};

/// What making the image took.
struct RenderStatistics {
  RayCounts rays;
  SampleCounts samples;
  double seconds = 0.0;         ///< wall time from its first tile's begin to its last tile's end
  double thread_seconds = 0.0;  ///< time that threads spent in its tiles
  int threads = 1;
};

struct RenderedImage {
  Image image;
  RenderStatistics statistics;
};

/// Number of tiles the image is cut into: the units that `progress` is advanced by.
std::size_t tile_count(const Scene& scene, const RenderSettings& settings);

/// How many rows the bands of the scene's image have: whole rows of tiles, and of chunks of the file.
int band_rows(const Scene& scene);

/// Whether all rows of the image are kept until it is complete (PartialImage).
bool keeps_rows(const Scene& scene);

/// The image before its first pixel is traced.
std::unique_ptr<PartialImage> begin_image(const Scene& scene, const RenderSettings& settings);

/// Traces the pixels that are not done, until all are or `stop` turns true: the pixels in hand are then
/// finished first, which takes a moment. `partial` is of this scene and these settings. Every pixel depends
/// on the scene, the seed, the image number and its own place alone: the same bits for any number of threads,
/// order of tiles and crop, and however often the image was put aside. The statistics are of this call.
///
/// An exception from a pixel leaves as a PixelFailure.
RenderStatistics render_missing(const Scene& scene, const RenderSettings& settings, PartialImage& partial,
                                const std::atomic<bool>& stop, ProgressReporter* progress);

/// An image in the hands of threads, tile by tile: what render_missing() does, for one who has the threads.
class ImageTracing {
 public:
  /// Everything given must outlive this. `file`, where there is one, gets the rows of `partial`.
  ImageTracing(const Scene& scene, const RenderSettings& settings, PartialImage& partial,
               const std::atomic<bool>& stop, ProgressReporter* progress, ImageFile* file = nullptr);
  ~ImageTracing();
  ImageTracing(const ImageTracing&) = delete;
  ImageTracing& operator=(const ImageTracing&) = delete;

  [[nodiscard]] std::size_t tile_count() const;

  /// Traces what is missing of a tile, unless the file has no use for it, in any order, on thread 0 ...
  /// settings.threads - 1, each of which is in one tile at a time. Throws as render_missing() does.
  void tile(std::size_t index, int thread);

  /// Of all tiles so far; none may be in hand. `seconds` is for the caller to fill in.
  [[nodiscard]] RenderStatistics statistics() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// A pixel could not be traced: what() says which, and why.
class PixelFailure : public std::runtime_error {
 public:
  PixelFailure(int at_x, int at_y, const std::string& why);
  int x;
  int y;
};

/// Begins and traces the whole image. Empty when `stop` turned true before the end.
std::optional<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                          const std::atomic<bool>& stop, ProgressReporter* progress);

}  // namespace backlight
