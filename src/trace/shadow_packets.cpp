#include "shadow_packets.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace backlight {
namespace {

constexpr int register_size = 8;

// The lowest eight bits, two bits apart.
std::uint32_t spread(std::uint32_t a) {
  a &= 0xffU;
  a = (a | (a << 8U)) & 0x00f00fU;
  a = (a | (a << 4U)) & 0x0c30c3U;
  return (a | (a << 2U)) & 0x249249U;
}

}  // namespace

void ShadowPackets::Rays::make_room(std::size_t more) {
  const std::size_t size = count + more;
  if (lane.size() >= size) return;
  for (std::vector<double>& numbers : column) numbers.resize(2 * size);
  lane.resize(2 * size);
}

LightRays ShadowPackets::Rays::view(std::size_t first) {
  LightRays rays{};
  for (std::size_t k = 0; k < 3; ++k) rays.way[k] = column[k].data() + first;
  rays.way_length = column[way_length].data() + first;
  rays.time = column[moment].data() + first;
  rays.lit = column[lit].data() + first;
  return rays;
}

void ShadowPackets::clear() {
  found_.count = 0;
  runs_.clear();
  shaded_.clear();
  has_.clear();
  unclear_.clear();
}

// Fills the last register with rays that are not lit.
void ShadowPackets::close_run(Run& run) {
  if (run.count == 0) return;
  const std::size_t end = run.first + static_cast<std::size_t>(padded_count(run.count));
  const std::size_t last = found_.count - 1;
  for (; found_.count < end; ++found_.count) {
    for (std::size_t k = 0; k < lit; ++k) found_.column[k][found_.count] = found_.column[k][last];
    found_.column[lit][found_.count] = 0.0;
  }
  runs_.push_back(run);
}

void ShadowPackets::add(const PointSheet& points, int sheet, int own) {
  const auto index = static_cast<std::size_t>(sheet);
  if (has_.size() <= index) {
    has_.resize(index + 1, 0);
    shaded_.resize(index + 1, 0);
  }
  has_[index] = 1;
  found_.make_room(sheet_size + sheet_size / few * register_size);
  for (int begin = 0; begin < points.count; begin += few) {
    Run run{0, static_cast<std::uint32_t>(found_.count), 0, sheet, own};
    for (int i = begin; i < std::min(begin + few, points.count); ++i) {
      const std::size_t to = found_.count;
      for (std::size_t k = 0; k < 3; ++k) found_.column[k][to] = points.way[k][i];
      found_.column[way_length][to] = points.way_length[i];
      found_.column[moment][to] = points.relative_emission_time[i];
      found_.column[lit][to] = 1.0;
      found_.lane[to] = static_cast<std::uint8_t>(i);
      const int more = points.lit[i] > 0.0 ? 1 : 0;  // else the next one takes its place
      found_.count += static_cast<std::size_t>(more);
      run.count += more;
    }
    close_run(run);
  }
}

bool ShadowPackets::has(int sheet) const {
  return static_cast<std::size_t>(sheet) < has_.size() && has_[static_cast<std::size_t>(sheet)] != 0;
}

std::span<const ShadowPackets::Unclear> ShadowPackets::unclear(int sheet) const {
  const auto before = [](const Unclear& a, const Unclear& b) { return a.sheet < b.sheet; };
  const auto [first, last] = std::equal_range(unclear_.begin(), unclear_.end(), Unclear{sheet, 0, 0}, before);
  return {first, last};
}

// Morton keys of two coordinates of the light's direction and of the moment of emission. Where rays go to the
// horizon, moments go to minus infinity: L/(L + t₁ - t), with L the shortest way and t₁ the last moment,
// spreads those that matter, and by as much as it does directions. A run has the place of its middle ray.
void ShadowPackets::make_keys() {
  const std::array<std::vector<double>, 6>& of = found_.column;
  const auto middle = [](const Run& run) { return run.first + static_cast<std::size_t>(run.count / 2); };
  Vec3 sum{0.0};
  double shortest = of[way_length][0], latest = of[moment][0];
  for (const Run& run : runs_) {
    const std::size_t i = middle(run);
    sum += Vec3{of[0][i], of[1][i], of[2][i]} / of[way_length][i];
    shortest = std::min(shortest, of[way_length][i]);
    latest = std::max(latest, of[moment][i]);
  }
  const Vec3 axis = glm::length(sum) > 0.0 ? glm::normalize(sum) : Vec3{0.0, 0.0, 1.0};
  const Vec3 across =
      glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.6 ? Vec3{1.0, 0.0, 0.0} : Vec3{0.0, 1.0, 0.0}));
  const Vec3 up = glm::cross(axis, across);
  Vec3 least{2.0}, most{-2.0};
  places_.resize(runs_.size());
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    const std::size_t i = middle(runs_[r]);
    const Vec3 way = Vec3{of[0][i], of[1][i], of[2][i]} / of[way_length][i];
    places_[r] = {glm::dot(way, across), glm::dot(way, up), shortest / (shortest + (latest - of[moment][i]))};
    least = glm::min(least, places_[r]);
    most = glm::max(most, places_[r]);
  }
  const Vec3 extent = most - least;
  const double scale = 255.0 / std::max({extent.x, extent.y, extent.z, 1e-300});
  for (std::size_t r = 0; r < runs_.size(); ++r) {
    for (int k = 0; k < 3; ++k) {
      const double at = (places_[r][k] - least[k]) * scale;
      const bool usable = at >= 0.0 && at <= 255.0;  // not where something is no number
      runs_[r].key |= spread(usable ? static_cast<std::uint32_t>(at) : 0U) << static_cast<unsigned>(k);
    }
  }
}

void ShadowPackets::sort() {
  make_keys();
  std::ranges::stable_sort(runs_, {}, &Run::key);
  rays_.count = 0;
  rays_.make_room(found_.count);
  for (Run& run : runs_) {
    const auto size = static_cast<std::size_t>(padded_count(run.count));
    for (std::size_t k = 0; k < rays_.column.size(); ++k) {
      std::copy_n(found_.column[k].data() + run.first, size, rays_.column[k].data() + rays_.count);
    }
    std::copy_n(found_.lane.data() + run.first, size, rays_.lane.data() + rays_.count);
    run.first = static_cast<std::uint32_t>(rays_.count);
    rays_.count += size;
  }
}

// Where a packet is best cut: at the highest bit of the keys that not all have.
std::size_t ShadowPackets::cut(std::size_t first, std::size_t last) const {
  const std::uint32_t different = runs_[first].key ^ runs_[last - 1].key;
  if (different == 0) return first + (last - first) / 2;
  const std::uint32_t bit = std::bit_floor(different);
  const auto begin = runs_.begin();
  const auto above = std::partition_point(begin + static_cast<std::ptrdiff_t>(first),
                                          begin + static_cast<std::ptrdiff_t>(last),
                                          [bit](const Run& run) { return (run.key & bit) == 0; });
  return static_cast<std::size_t>(above - begin);
}

// The occluders of a packet, or null: there are none. Where a sample says that most would stay in the list,
// none is made: many are as many numbers as the caches hold.
const LampTable* ShadowPackets::list(const SheetKernels& kernels, const LampTable& from,
                                     std::size_t first_run, std::size_t last_run, LampTable& to,
                                     double& time) {
  constexpr int sample = 256;
  const std::size_t first = runs_[first_run].first;
  const std::size_t end = last_run < runs_.size() ? runs_[last_run].first : rays_.count;
  Bundle bundle;
  if (!kernels.light_bundle(rays_.view(first), 0, static_cast<int>(end - first), bundle)) return nullptr;
  time = bundle.time;
  if (from.count > 8 * sample && last_run - first_run > 1) {
    LampTable some = from;
    some.count = sample;
    kernels.overlapping_lamps(some, bundle, to);
    if (to.count > sample / 4 * 3) return &from;
  }
  kernels.overlapping_lamps(from, bundle, to);
  return to.count > 0 ? &to : nullptr;
}

void ShadowPackets::sift(const SheetKernels& kernels, const LampTable& occluders,
                         std::span<LampStore> lists) {
  if (runs_.empty() || occluders.count == 0) return;
  sort();
  sift_packet(kernels, occluders, 0, runs_.size(), lists);
  for (const Run& run : runs_) {
    for (std::size_t i = run.first; i < run.first + static_cast<std::size_t>(run.count); ++i) {
      if (rays_.column[lit][i] > 0.0) continue;
      shaded_[static_cast<std::size_t>(run.sheet)] |= std::uint64_t{1} << rays_.lane[i];
    }
  }
  std::ranges::sort(unclear_, {}, &Unclear::sheet);
}

// Each packet's list is drawn from that of the packet that it is a part of.
void ShadowPackets::sift_packet(const SheetKernels& kernels, const LampTable& from, std::size_t first,
                                std::size_t last, std::span<LampStore> lists) {
  double time = 0.0;
  if (first == last) return;
  const LampTable* const listed = list(kernels, from, first, last, lists[0].table(), time);
  if (listed == nullptr) return;
  const LampTable& near = *listed;
  if (near.count <= few_occluders || last - first == 1 || lists.size() == 1) {
    for (std::size_t run = first; run < last; ++run) sift_run(kernels, near, time, runs_[run]);
    return;
  }
  const std::size_t middle = cut(first, last);
  const std::size_t quarter = middle - first > 1 ? cut(first, middle) : middle;
  const std::size_t three_quarters = last - middle > 1 ? cut(middle, last) : last;
  const std::size_t cuts[] = {first, quarter, middle, three_quarters, last};
  for (std::size_t i = 0; i + 1 < std::size(cuts); ++i) {
    sift_packet(kernels, near, cuts[i], cuts[i + 1], lists.subspan(listed == &from ? 0 : 1));
  }
}

void ShadowPackets::sift_run(const SheetKernels& kernels, const LampTable& near, double time,
                             const Run& run) {
  const LightRays rays = rays_.view(run.first);
  for (int k = 0; k < near.count; ++k) {
    const int who = static_cast<int>(near.who[k]);
    if (who == run.own) continue;
    const std::uint64_t unclear = kernels.sift(near, k, time, 0, padded_count(run.count), rays);
    if (unclear != 0) note(run, unclear, who);
  }
}

void ShadowPackets::note(const Run& run, std::uint64_t rays, int who) {
  std::uint64_t of_sheet = 0;
  for (; rays != 0; rays &= rays - 1) {
    of_sheet |= std::uint64_t{1} << rays_.lane[run.first + static_cast<std::size_t>(__builtin_ctzll(rays))];
  }
  unclear_.push_back({run.sheet, who, of_sheet});
}

}  // namespace backlight
