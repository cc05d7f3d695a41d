// How many samples a pixel gets where an error is asked for instead of a number of samples.
//
// docs/command-line.md says what is promised; tests/laws/tolerance_test.cpp measures what is delivered.
#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "backlight/base/vector.h"
#include "backlight/camera/sampling.h"
#include "backlight/film/image.h"
#include "backlight/trace/outlines.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

/// One sample of the image.
struct PixelSample {
  Vec3 colour{0.0};      ///< film colour; black where there is nothing
  bool covered = false;  ///< whether a surface is there, or a background that the scene gives
};

/// Traces the rays through these points of the image into `samples`, in order. Returns false when it was
/// stopped.
using TracePoints =
    std::function<bool(std::span<const ImagePoint> points, std::vector<PixelSample>& samples)>;

/// What its samples say of a pixel.
struct PixelEstimate {
  Vec3 colour{0.0};       ///< the estimate of its mean
  double coverage = 0.0;  ///< share of it that is covered: alpha
  int samples = 0;        ///< how many there are
  bool at_limit = false;  ///< most_adaptive_samples were not enough for the error asked for
};

/// Samples of one area, summed up.
struct Moments {
  int count = 0;
  int covered = 0;
  Vec3 mean{0.0};
  Vec3 squares{0.0};  ///< sum of the squares of the distances from the mean

  void add(const PixelSample& sample);  ///< Welford 1962
};

/// When a pixel has enough samples. With v the variance of its samples and n their number, the square of the
/// error of their mean is about v n^(-3/2): that of an edge through evenly spread samples; what is smooth is
/// better. Where every pixel stops at v/n² <= gain, no sample would lower the sum of these squares more
/// anywhere else than where it is; and whatever the image, no pixel is to be expected further off than
/// `most`.
struct SamplingLaw {
  double gain = 0.0;  ///< > 0; on the scale of shown_value(), squared
  double most = 0.0;  ///< > 0; on that scale

  /// How many samples an area of this variance (on that scale, times the square of its share of the pixel)
  /// needs.
  [[nodiscard]] double samples_for(double variance) const;

  /// Whether `count` are not enough.
  [[nodiscard]] bool wants_more(double variance, double count) const {
    return variance > gain * count * count || variance > most * most * count * std::sqrt(count);
  }
};

/// The first samples of a box of pixels: the same of each pixel, whatever box it is in.
class FirstLook {
 public:
  /// Returns false when it was stopped. `key`: its seed and image.
  bool take(const PixelBox& box, const SampleKey& key, int count, const TracePoints& trace);

  [[nodiscard]] const Moments& of(int x, int y) const { return moments_[place(x, y)]; }
  [[nodiscard]] std::span<const PixelSample> samples(int x, int y) const {
    return {samples_.data() + place(x, y) * static_cast<std::size_t>(count_),
            static_cast<std::size_t>(count_)};
  }

  /// A variance (film units) for a pixel of the box before more is known: the mean, over it and its
  /// neighbours in the box, of the variance of their samples and of a quarter of the square of their
  /// differences from it.
  [[nodiscard]] Vec3 prior(int x, int y) const;

 private:
  [[nodiscard]] std::size_t place(int x, int y) const;
  void sum_up();

  PixelBox box_;
  int count_ = 0;
  std::vector<ImagePoint> points_;
  std::vector<PixelSample> samples_;  // of all pixels, `count_` of each
  std::vector<Moments> moments_;
  std::vector<Vec3> variances_;  // of one sample
};

/// What is known of the variance of an area's samples (film units): the prior counts as much as one of them,
/// and less beside many that do not show it.
Vec3 variance_of(const Moments& moments, const Vec3& prior);

/// A variance in film units on the scale of shown_value(), about `mean`: mean of the three channels.
/// `shrink`: over which part of the standard deviation the slope of the scale is taken.
double shown_variance(const Vec3& variance, const Vec3& mean, double shrink);

/// The variance of samples in the square about a disc, for a contrast of 1: pi/4 (1 - pi/4), and twice that,
/// since the outline is three times as long as an edge through the square.
inline constexpr double disc_variance = 0.34;

/// What all threads share of an image with a tolerance.
struct SamplingPlan {
  PixelBox picture;     ///< the full image
  SampleKey key;        ///< its seed and its image are those of all samples
  int first_count = 2;  ///< first samples of each pixel
  SamplingLaw law;      ///< for the whole image
};

/// Finds the law by which the error of the whole image will be `tolerance`: from a look at blocks of pixels
/// spread over the full image, one pixel in twenty, but no fewer than some 400 and no more than 2000, and at
/// some of the small things. `key`: seed and image of all samples. `trace` is not to stop. Throws what it
/// throws.
SamplingPlan make_plan(double tolerance, const PixelBox& picture, const SampleKey& key,
                       std::span<const SmallThing> small, const TracePoints& trace);

/// Chooses the samples of a tile's pixels. One for each thread: it keeps its memory between tiles.
///
/// All pixels get a few first samples; the variance of theirs, and of their neighbours', says by the law how
/// many more, which says it better, until there are enough. What a small thing may cover in a pixel
/// (trace/outlines.h) is a part with samples of its own if a ray at it brings light that would matter: so
/// that things smaller than a pixel are found, and take no more samples than large ones. Nothing but the
/// pixel and its eight neighbours on the full image is looked at, and those outside the tile are traced
/// again: the same bits for any tiles and crop.
class AdaptiveSampler {
 public:
  explicit AdaptiveSampler(const SamplingPlan& plan) : plan_(plan) {}

  /// Estimates the pixels `wanted` of a tile, in order; returns false when it was stopped before the end.
  /// `small`: the small things of the whole view. Throws what `trace` throws.
  bool tile(const PixelBox& tile, std::span<const TilePixel> wanted, std::span<const SmallThing> small,
            const TracePoints& trace);

  /// Those of the last tile.
  [[nodiscard]] const std::vector<PixelEstimate>& estimates() const { return estimates_; }

 private:
  // Of the unit square that a pixel is.
  struct Box {
    double x0 = 0.0, y0 = 0.0, x1 = 1.0, y1 = 1.0;
    [[nodiscard]] double area() const { return (x1 - x0) * (y1 - y0); }
    [[nodiscard]] bool has(const ImagePoint& p) const {
      return p.x >= x0 && p.x < x1 && p.y >= y0 && p.y < y1;
    }
    [[nodiscard]] bool meets(const Box& other) const {
      return x0 < other.x1 && other.x0 < x1 && y0 < other.y1 && other.y0 < y1;
    }
    void include(const Box& other);
  };

  // An area with samples of its own: a small thing's box, or what these leave of the pixel.
  struct Area {
    std::size_t pixel = 0;  // its place among the estimates
    SampleKey key;
    Box box;
    double share = 1.0;  // of the pixel
    Vec3 prior{0.0};     // a variance that counts as much as one sample's, and less when there are many
    Moments moments;
    int drawn = 0;  // samples of its sequence so far, with those that fell into a small thing's box
    int goal = 0;
  };

  struct Pixel {
    std::size_t first_area = 0;  // the rest of the pixel; its small things' follow
    std::size_t areas = 1;
  };

  struct Probe {
    std::size_t pixel = 0;
    Box box;
  };

  bool probe(std::span<const TilePixel> wanted, std::span<const SmallThing> small, const TracePoints& trace);
  void divide(std::span<const TilePixel> wanted);
  void divide(std::size_t pixel, const TilePixel& at, std::span<const Probe> probes,
              std::span<const PixelSample> seen);
  bool refine(const TracePoints& trace);
  bool draw(const TracePoints& trace);
  bool trace_drawn(const TracePoints& trace);
  [[nodiscard]] bool in_small_thing(const Area& area, const ImagePoint& place) const;
  void settle(std::size_t pixel);
  [[nodiscard]] bool wants_more(const Area& area, const Vec3& mean) const;

  const SamplingPlan& plan_;
  FirstLook first_;
  std::vector<PixelEstimate> estimates_;
  std::vector<Pixel> pixels_;
  std::vector<Area> areas_;
  std::vector<Probe> probes_;
  std::vector<PixelSample> probed_;
  std::vector<std::size_t> busy_;  // pixels that want more
  std::vector<ImagePoint> points_;
  std::vector<std::size_t> point_area_;
  std::vector<PixelSample> samples_;
};

}  // namespace backlight
