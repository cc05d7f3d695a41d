#include "backlight/render/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

#include "backlight/film/display.h"
#include "backlight/scene/scene.h"

namespace backlight {
namespace {

constexpr std::size_t most_points = 1024;  // traced at once
constexpr std::size_t most_probes = 64;    // of a pixel
constexpr std::size_t most_parts = 8;      // of a pixel; more small things than that are one
constexpr double least_rest = 0.1;  // of a pixel beside its parts: with less, most of its samples are in vain

Vec3 shown(const Vec3& film) {
  return {shown_value(film.r), shown_value(film.g), shown_value(film.b)};
}

constexpr double full_prior = 16.0;       // samples beside which it counts in full
constexpr double steepest_shown = 12.92;  // slope of shown_value(), where it is dark

// The part of the standard deviation that the error of a mean is.
double shrink_of(double count) {
  return 1.0 / std::sqrt(count * std::sqrt(count));
}

// Of two values on the scale of shown_value(), over the channels.
double square_of_difference(const Vec3& a, const Vec3& b) {
  const Vec3 d = shown(a) - shown(b);
  return glm::dot(d, d) / 3.0;
}

}  // namespace

void Moments::add(const PixelSample& sample) {
  ++count;
  covered += sample.covered ? 1 : 0;
  const Vec3 from_old = sample.colour - mean;
  mean += from_old / double(count);
  squares += from_old * (sample.colour - mean);
}

Vec3 variance_of(const Moments& moments, const Vec3& prior) {
  const double n = std::max(1, moments.count);
  return (prior * std::min(1.0, full_prior / n) + moments.squares) / n;
}

double shown_variance(const Vec3& variance, const Vec3& mean, double shrink) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    if (variance[c] == 0.0) continue;
    const double step = shrink * std::sqrt(variance[c]) + 1e-9;
    const double slope = (shown_value(mean[c] + step) - shown_value(mean[c] - step)) / (2.0 * step);
    sum += variance[c] * slope * slope;
  }
  return sum / 3.0;
}

std::size_t FirstLook::place(int x, int y) const {
  return static_cast<std::size_t>(y - box_.y0) * static_cast<std::size_t>(box_.width()) +
         static_cast<std::size_t>(x - box_.x0);
}

bool FirstLook::take(const PixelBox& box, const SampleKey& key, int count, const TracePoints& trace) {
  box_ = box;
  count_ = count;
  points_.clear();
  samples_.clear();
  std::vector<PixelSample> traced;
  for (int y = box.y0; y < box.y1; ++y) {
    for (int x = box.x0; x < box.x1; ++x) {
      for (int i = 0; i < count; ++i) {
        const ImagePoint place = unit_sample({key.seed, key.image, x, y}, i);
        points_.push_back({x + place.x, y + place.y});
      }
    }
    if (y + 1 < box.y1 && points_.size() < most_points) continue;
    const bool went_on = trace(points_, traced);
    points_.clear();
    if (!went_on) return false;
    samples_.insert(samples_.end(), traced.begin(), traced.end());
  }
  sum_up();
  return true;
}

void FirstLook::sum_up() {
  moments_.clear();
  variances_.clear();
  const auto count = static_cast<std::size_t>(count_);
  for (std::size_t first = 0; first < samples_.size(); first += count) {
    Moments moments;
    for (std::size_t i = first; i < first + count; ++i) moments.add(samples_[i]);
    moments_.push_back(moments);
    variances_.push_back(moments.squares / std::max(1.0, double(count_ - 1)));
  }
}

Vec3 FirstLook::prior(int x, int y) const {
  const Vec3& own = of(x, y).mean;
  Vec3 sum{0.0};
  int pixels = 0;
  for (int j = std::max(box_.y0, y - 1); j < std::min(box_.y1, y + 2); ++j) {
    for (int i = std::max(box_.x0, x - 1); i < std::min(box_.x1, x + 2); ++i) {
      const std::size_t near = place(i, j);
      const Vec3 difference = moments_[near].mean - own;
      sum += variances_[near] + 0.25 * difference * difference;
      ++pixels;
    }
  }
  return sum / double(pixels);
}

void AdaptiveSampler::Box::include(const Box& other) {
  x0 = std::min(x0, other.x0);
  y0 = std::min(y0, other.y0);
  x1 = std::max(x1, other.x1);
  y1 = std::max(y1, other.y1);
}

bool AdaptiveSampler::tile(const PixelBox& tile, std::span<const TilePixel> wanted,
                           std::span<const SmallThing> small, const TracePoints& trace) {
  const PixelBox& picture = plan_.picture;
  const PixelBox box{std::max(picture.x0, tile.x0 - 1), std::max(picture.y0, tile.y0 - 1),
                     std::min(picture.x1, tile.x1 + 1), std::min(picture.y1, tile.y1 + 1)};
  if (!first_.take(box, plan_.key, plan_.first_count, trace)) return false;
  if (!probe(wanted, small, trace)) return false;
  divide(wanted);
  return refine(trace);
}

// One ray at the middle of each small thing: it is in no mean.
bool AdaptiveSampler::probe(std::span<const TilePixel> wanted, std::span<const SmallThing> small,
                            const TracePoints& trace) {
  probes_.clear();
  probed_.clear();
  points_.clear();
  for (std::size_t k = 0; k < wanted.size() && !small.empty(); ++k) {
    const auto [x, y] = wanted[k];
    const auto before = [](const SmallThing& thing, const TilePixel& pixel) {
      return thing.y != pixel.y ? thing.y < pixel.y : thing.x < pixel.x;
    };
    auto thing = std::lower_bound(small.begin(), small.end(), wanted[k], before);
    for (std::size_t n = 0; n < most_probes && thing != small.end(); ++n, ++thing) {
      if (thing->x != x || thing->y != y) break;
      probes_.push_back({k, {thing->x0, thing->y0, thing->x1, thing->y1}});
      points_.push_back(thing->centre);
    }
  }
  for (std::size_t begin = 0; begin < points_.size(); begin += most_points) {
    const std::size_t count = std::min(most_points, points_.size() - begin);
    if (!trace({points_.data() + begin, count}, samples_)) return false;
    probed_.insert(probed_.end(), samples_.begin(), samples_.end());
  }
  return true;
}

void AdaptiveSampler::divide(std::span<const TilePixel> wanted) {
  estimates_.assign(wanted.size(), {});
  pixels_.clear();
  areas_.clear();
  std::size_t next = 0;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const std::size_t begin = next;
    while (next < probes_.size() && probes_[next].pixel == k) ++next;
    divide(k, wanted[k], {probes_.data() + begin, next - begin}, {probed_.data() + begin, next - begin});
  }
}

// A pixel's areas: those of the small things that matter, and before them the rest of it.
void AdaptiveSampler::divide(std::size_t pixel, const TilePixel& at, std::span<const Probe> probes,
                             std::span<const PixelSample> seen) {
  const Moments& look = first_.of(at.x, at.y);
  const std::size_t rest = areas_.size();
  areas_.push_back({pixel, {plan_.key.seed, plan_.key.image, at.x, at.y}, {}, 1.0, first_.prior(at.x, at.y)});
  std::vector<Area> parts;
  for (std::size_t i = 0; i < probes.size(); ++i) {
    const Box& box = probes[i].box;
    const Vec3 difference = seen[i].colour - look.mean;
    // What the pixel would be off without it, were all of its small things like it; samples of it would
    // scatter by about half of that.
    const double share = std::min(1.0, box.area() * double(probes.size()));
    const double off = square_of_difference(look.mean + share * difference, look.mean);
    if (!plan_.law.wants_more(0.25 * off, 1.0)) continue;
    Area part{pixel, areas_[rest].key, box, 0.0, disc_variance * difference * difference};
    // Those that it overlaps become one with it, and that with others.
    for (std::size_t k = 0; k < parts.size();) {
      if (!parts[k].box.meets(part.box) && parts.size() < most_parts) {
        ++k;
        continue;
      }
      part.box.include(parts[k].box);
      part.prior = glm::max(part.prior, parts[k].prior);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(k));
      k = 0;
    }
    parts.push_back(part);
  }
  double share = 0.0;
  for (const Area& part : parts) share += part.box.area();
  if (share > 1.0 - least_rest) {  // nearly all of it: the whole, of which it is known that it is not even
    for (const Area& part : parts) areas_[rest].prior += part.prior;
    parts.clear();
    share = 0.0;
  }
  areas_[rest].share = 1.0 - share;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    parts[k].share = parts[k].box.area();
    parts[k].key.part = static_cast<int>(k) + 1;
    areas_.push_back(parts[k]);
  }
  pixels_.push_back({rest, 1 + parts.size()});
  Area& whole = areas_[rest];
  whole.drawn = plan_.first_count;
  if (parts.empty()) {
    whole.moments = look;
    return;
  }
  const std::span<const PixelSample> samples = first_.samples(at.x, at.y);
  for (int i = 0; i < plan_.first_count; ++i) {
    if (!in_small_thing(whole, unit_sample(whole.key, i)))
      whole.moments.add(samples[static_cast<std::size_t>(i)]);
  }
}

bool AdaptiveSampler::in_small_thing(const Area& area, const ImagePoint& place) const {
  if (area.key.part != 0) return false;
  const Pixel& pixel = pixels_[area.pixel];
  for (std::size_t i = 1; i < pixel.areas; ++i) {
    if (areas_[pixel.first_area + i].box.has(place)) return true;
  }
  return false;
}

// All pixels that want more in one go, until none does.
bool AdaptiveSampler::refine(const TracePoints& trace) {
  busy_.clear();
  for (std::size_t k = 0; k < pixels_.size(); ++k) {
    settle(k);
    if (estimates_[k].samples < 0) busy_.push_back(k);
  }
  while (!busy_.empty()) {
    if (!draw(trace)) return false;
    for (const std::size_t k : busy_) settle(k);
    std::erase_if(busy_, [this](std::size_t k) { return estimates_[k].samples >= 0; });
  }
  return true;
}

// The samples that lie next to one another in a pixel next to one another: coherent rays.
bool AdaptiveSampler::draw(const TracePoints& trace) {
  points_.clear();
  point_area_.clear();
  for (const std::size_t k : busy_) {
    for (std::size_t i = 0; i < pixels_[k].areas; ++i) {
      const std::size_t at = pixels_[k].first_area + i;
      Area& area = areas_[at];
      const Box& box = area.box;
      for (int have = area.moments.count; have < area.goal;) {
        const ImagePoint place = unit_sample(area.key, area.drawn++);
        if (in_small_thing(area, place)) continue;
        ++have;
        points_.push_back({area.key.x + box.x0 + place.x * (box.x1 - box.x0),
                           area.key.y + box.y0 + place.y * (box.y1 - box.y0)});
        point_area_.push_back(at);
        if (points_.size() == most_points && !trace_drawn(trace)) return false;
      }
    }
  }
  return points_.empty() || trace_drawn(trace);
}

bool AdaptiveSampler::trace_drawn(const TracePoints& trace) {
  if (!trace(points_, samples_)) return false;
  for (std::size_t i = 0; i < points_.size(); ++i) areas_[point_area_[i]].moments.add(samples_[i]);
  points_.clear();
  point_area_.clear();
  return true;
}

bool AdaptiveSampler::wants_more(const Area& area, const Vec3& mean) const {
  const double n = std::max(1, area.moments.count);
  Vec3 variance = variance_of(area.moments, area.prior);
  // Of a ball it is known from the outset.
  if (area.key.part != 0) variance = glm::max(area.moments.squares / n, area.prior);
  variance *= area.share * area.share;
  // Most pixels need no more than this to be done.
  const double most = steepest_shown * steepest_shown / 3.0 * (variance.r + variance.g + variance.b);
  if (!plan_.law.wants_more(most, n)) return false;
  return plan_.law.wants_more(shown_variance(variance, mean, shrink_of(n)), n);
}

// The estimate of a pixel from its samples so far; of -1 samples where it wants more, and its areas have
// their goals.
void AdaptiveSampler::settle(std::size_t pixel) {
  PixelEstimate estimate;
  const std::span<Area> areas{areas_.data() + pixels_[pixel].first_area, pixels_[pixel].areas};
  for (const Area& area : areas) {
    if (area.moments.count == 0) continue;
    estimate.colour += area.share * area.moments.mean;
    estimate.coverage += area.share * area.moments.covered / area.moments.count;
    estimate.samples += area.moments.count;
  }
  bool is_done = true;
  for (Area& area : areas) {
    const int count = area.moments.count;
    area.goal = std::max(1, count);
    if (count > 0 && wants_more(area, estimate.colour)) {
      area.goal = std::min(2 * count, most_adaptive_samples);
      estimate.at_limit = estimate.at_limit || count >= most_adaptive_samples;
    }
    is_done = is_done && area.goal == count;
  }
  if (!is_done) estimate.samples = -1;
  estimates_[pixel] = estimate;
}

}  // namespace backlight
