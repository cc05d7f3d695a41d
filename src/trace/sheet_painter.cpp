#include "sheet_painter.h"

#include <algorithm>
#include <utility>

#include "tile_rays.h"

namespace backlight {
namespace {

using TileSheet = SheetScratch::TileSheet;

class SheetPainter {
 public:
  SheetPainter(const Tracer& tracer, const SheetScene& scene, const std::vector<bool>& relays, int eye,
               TileAnswers wanted, SheetScratch& work, Scratch& scratch, TileLight& light)
      : tracer_(tracer),
        scene_(scene),
        eye_(eye),
        colours_(wanted.colours),
        records_(wanted.records),
        relays_(relays),
        work_(work),
        scratch_(scratch),
        light_(light),
        shader_(tracer, scene, eye, work, scratch) {}

  void paint() {
    const Scene& scene = tracer_.scene();
    paint(scene.effects);
    for (const EffectsRegion& region : scene.regions) paint(region.effects);
  }

 private:
  void paint(const Effects& effects) {
    sort(effects);
    if (work_.groups.empty()) return;
    work_.points.light_delay = effects.light_delay || is_passed_on();
    shader_.begin_tile(effects);
    if (colours_ && shader_.wants_packets()) {
      for_each_sheet([&] { shader_.collect(); });
      shader_.sift_packets();
    }
    for_each_sheet([&] { paint_points(effects); });
  }

  // Whole sheets as they are; what is left of others together, so that lanes are filled.
  template <class Work>
  void for_each_sheet(const Work& work) {
    const auto do_points = [&] {
      pad_points();
      shader_.begin_points();
      work();
      work_.points.count = 0;
    };
    for (const auto& group : work_.groups) {
      for (int i = group.next - group.count; i < group.next; ++i) {
        const auto& part = work_.sorted[static_cast<std::size_t>(i)];
        if (part.mask != ~std::uint64_t{0}) continue;
        gather(part);
        do_points();
      }
      for (int i = group.next - group.count; i < group.next; ++i) {
        auto part = work_.sorted[static_cast<std::size_t>(i)];
        if (part.mask == ~std::uint64_t{0}) continue;
        while (part.mask != 0) {
          part.mask = gather(part);
          if (work_.points.count == sheet_size) do_points();
        }
      }
      if (work_.points.count > 0) do_points();
    }
  }

  // Sorts the lanes by the groups of what they hit, and paints those that hit nothing, or something far away
  // in a fast frame.
  void sort(const Effects& effects) {
    work_.groups.clear();
    work_.parts.clear();
    for (std::size_t s = 0; s < work_.sheets.size(); ++s) {
      const TileSheet& sheet = work_.sheets[s];
      if (sheet.effects != &effects) continue;
      std::uint64_t left = first_bits(sheet.rays.count);
      while (left != 0) {
        const double who = sheet.hits.who[__builtin_ctzll(left)];
        const std::uint64_t mask = left & scene_.kernels().same(sheet.hits.who, sheet.rays.count, who);
        left &= ~mask;
        if (who < 0.0) {
          without_surface(sheet, mask, who == far_hit);
          continue;
        }
        const int number = static_cast<int>(who);
        const auto key = static_cast<std::size_t>(scene_.numbered(number).group);
        int& group = work_.group_of[key];
        if (group < 0) {
          group = static_cast<int>(work_.groups.size());
          work_.groups.push_back({key, 0, 0});
        }
        ++work_.groups[static_cast<std::size_t>(group)].count;
        work_.parts.push_back({group, static_cast<int>(s), number, mask});
      }
    }
    int total = 0;
    for (auto& group : work_.groups) {
      work_.group_of[group.key] = -1;
      group.next = total;
      total += group.count;
    }
    work_.sorted.resize(work_.parts.size());
    for (const auto& part : work_.parts) {
      int& next = work_.groups[static_cast<std::size_t>(part.group)].next;
      work_.sorted[static_cast<std::size_t>(next++)] = part;
    }
  }

  void without_surface(const TileSheet& sheet, std::uint64_t mask, bool far) {
    const Sky& sky = tracer_.scene().sky;
    if (!far && !sky.given) {
      for (std::uint64_t left = mask; left != 0; left &= left - 1) {
        light_.covered[static_cast<std::size_t>(sheet.place[__builtin_ctzll(left)])] = 0;
      }
    }
    if (!far && !records_ && !sky.emits) {
      for (; mask != 0; mask &= mask - 1) {
        light_.set_colour(static_cast<std::size_t>(sheet.place[__builtin_ctzll(mask)]), LinearRgb{0.0});
      }
      return;
    }
    const auto frame = static_cast<std::size_t>(sky.frame);
    if (!far && !records_ && !scene_.hub().frames[frame].from_camera.is_robust()) {
      shader_.shade_sky(sheet.rays, mask, *sheet.effects);
      const auto& rgb = work_.points.rgb;
      for (; mask != 0; mask &= mask - 1) {
        const int lane = __builtin_ctzll(mask);
        const auto place = static_cast<std::size_t>(sheet.place[lane]);
        const LinearRgb colour{rgb[0][lane], rgb[1][lane], rgb[2][lane]};
        light_.set_colour(place, is_passed_on() ? work_.legs[place].leg.weight * colour : colour);
      }
      return;
    }
    for (; mask != 0; mask &= mask - 1) {
      const int lane = __builtin_ctzll(mask);
      one_ray(sheet, lane, far ? work_.far_hits[static_cast<std::size_t>(sheet.place[lane])] : FirstHit{});
    }
  }

  // One ray by the law alone, but for the search.
  void one_ray(const TileSheet& sheet, int lane, const FirstHit& hit) {
    const auto place = static_cast<std::size_t>(sheet.place[lane]);
    const bool dark = !hit.found() && !tracer_.scene().sky.emits;
    if (is_passed_on()) {
      const Leg& leg = work_.legs[place].leg;
      scratch_.rays.start(scene_.hub(), leg.ray);
      light_.set_colour(place, dark ? LinearRgb{0.0} : colour_of(leg, hit, sheet, place));
      return;
    }
    const CameraRay ray = camera_ray_of(tracer_.scene(), sheet.rays, lane, eye_);
    if (colours_) {
      scratch_.rays.start(ray);
      if (hit.found()) ++scratch_.counts.single;
      if (hit.hit.unresolved) ++scratch_.counts.unresolved;
      light_.set_colour(place, dark ? LinearRgb{0.0} : colour_of(tracer_.camera_leg(ray), hit, sheet, place));
    }
    if (records_) {
      scratch_.rays.start(ray);
      light_.record[place] = tracer_.surface_of(ray, hit, scratch_);
    }
  }

  // By the law, but for what goes on from a mirror, which is put off.
  LinearRgb colour_of(const Leg& leg, const FirstHit& hit, const TileSheet& sheet, std::size_t place) {
    LegWanted wanted{&relays_, leg.passed};
    const Lent lent(scratch_.leg_wanted, wanted);
    const LinearRgb colour = tracer_.colour_of(leg, hit, *sheet.effects, scratch_);
    if (wanted.leg) work_.put_off.push_back({*std::move(wanted.leg), wanted.frame, sheet.effects, place});
    return colour;
  }

  [[nodiscard]] bool is_passed_on() const { return !work_.legs.empty(); }

  // Adds lanes of a sheet to the points, as many as there is room for; returns the others.
  std::uint64_t gather(const SheetScratch::Part& part) {
    PointSheet& p = work_.points;
    const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(part.sheet)];
    const int first = p.count;
    std::uint64_t left = part.mask;
    if (first == 0) p.run_count = 0;
    if (left == ~std::uint64_t{0}) {
      take_whole(part.sheet, sheet);
      left = 0;
    } else if (first == 0) {
      p.whole = -1;
      for (int k = 0; k < 3; ++k) p.direction[k] = p.gathered[k];
      p.hits = &p.gathered_hits;
      p.starts = sheet.rays.displaced ? &p.gathered_starts : nullptr;
    }
    for (; left != 0 && p.count < sheet_size; left &= left - 1, ++p.count) {
      const int lane = __builtin_ctzll(left);
      p.lane[p.count] = part.sheet * sheet_size + lane;
      for (int k = 0; k < 3; ++k) p.gathered[k][p.count] = sheet.rays.direction[k][lane];
      if (p.starts != nullptr) gather_start(sheet.rays.starts, lane);
      p.gathered_hits.lambda[p.count] = sheet.hits.lambda[lane];
      p.gathered_hits.along[p.count] = sheet.hits.along[lane];
      p.gathered_hits.part[p.count] = sheet.hits.part[lane];
    }
    PointSheet::Run* const before = p.run_count > 0 ? &p.runs[p.run_count - 1] : nullptr;
    if (before != nullptr && before->surface == part.surface) {
      before->last = p.count;
    } else {
      p.runs[p.run_count++] = {part.surface, first, p.count};
    }
    return left;
  }

  void gather_start(const RayStarts& from, int lane) {
    RayStarts& to = work_.points.gathered_starts;
    const int i = work_.points.count;
    to.length[i] = from.length[lane];
    to.time[i] = from.time[lane];
    for (int k = 0; k < 3; ++k) to.place[k][i] = from.place[k][lane];
  }

  void take_whole(int index, const TileSheet& sheet) {
    PointSheet& p = work_.points;
    p.whole = index;
    p.starts = sheet.rays.own_starts();
    for (int k = 0; k < 3; ++k) p.direction[k] = sheet.rays.direction[k];
    p.hits = &sheet.hits;
    for (int i = 0; i < sheet_size; ++i) p.lane[i] = index * sheet_size + i;
    p.count = sheet_size;
  }

  void pad_points() {
    PointSheet& p = work_.points;
    p.padded = padded_count(p.count);
    for (int i = p.count; i < p.padded; ++i) {
      for (auto& row : p.gathered) row[i] = row[p.count - 1];
      for (double* row : {p.gathered_hits.lambda, p.gathered_hits.along, p.gathered_hits.part})
        row[i] = row[p.count - 1];
      RayStarts& starts = p.gathered_starts;
      for (double* row : {starts.length, starts.time, starts.place[0], starts.place[1], starts.place[2]})
        row[i] = row[p.count - 1];
    }
  }

  // The colours of the points gathered.
  void paint_points(const Effects& effects) {
    const PointSheet& p = work_.points;
    const bool lanes = shader_.in_lanes();
    const bool one_material = lanes && shader_.resolve();
    if (!lanes || shader_.is_too_fast()) {
      for (int i = 0; i < p.count; ++i) {
        const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
        one_ray(sheet, p.lane[i] % sheet_size, shader_.hit(i));
      }
    } else if (one_material || !colours_) {
      if (colours_) shader_.shade(effects);
      put_colours();
    } else {
      paint_by_material(effects);
    }
  }

  // Of points of several materials, those of each.
  void paint_by_material(const Effects& effects) {
    PointSheet& p = work_.points;
    std::vector<std::pair<int, SheetScratch::Part>> parts;  // by material
    for (int r = 0; r < p.run_count; ++r) {
      for (int i = p.runs[r].first; i < p.runs[r].last; ++i) {
        const std::uint64_t bit = std::uint64_t{1} << (p.lane[i] % sheet_size);
        parts.push_back({p.material[i], {0, p.lane[i] / sheet_size, p.runs[r].surface, bit}});
      }
    }
    std::ranges::stable_sort(parts, {}, [](const auto& part) { return part.first; });
    for (auto part = parts.begin(); part != parts.end();) {
      const int material = part->first;
      p.count = 0;
      for (; part != parts.end() && part->first == material; ++part) gather(part->second);
      pad_points();
      shader_.resolve();
      shader_.shade(effects);
      put_colours();
    }
  }

  void put_colours() {
    PointSheet& p = work_.points;
    for (int i = 0; i < p.count && is_passed_on(); ++i) {
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
      const auto place = static_cast<std::size_t>(sheet.place[p.lane[i] % sheet_size]);
      for (int k = 0; k < 3; ++k) p.rgb[k][i] = work_.legs[place].leg.weight[k] * p.rgb[k][i];
    }
    const bool camera = colours_ && !is_passed_on();
    const std::uint64_t unresolved = camera ? p.unresolved & first_bits(p.count) : 0;
    scratch_.counts.unresolved += static_cast<std::uint64_t>(__builtin_popcountll(unresolved));
    if (p.whole >= 0 && !records_) {
      const int first = work_.sheets[static_cast<std::size_t>(p.whole)].place[0];  // of 64 neighbours
      for (std::size_t k = 0; k < 3; ++k) std::copy_n(p.rgb[k], sheet_size, light_.rgb[k].data() + first);
      return;
    }
    for (int i = 0; i < p.count; ++i) {
      const TileSheet& sheet = work_.sheets[static_cast<std::size_t>(p.lane[i] / sheet_size)];
      const auto place = static_cast<std::size_t>(sheet.place[p.lane[i] % sheet_size]);
      if (colours_) light_.set_colour(place, {p.rgb[0][i], p.rgb[1][i], p.rgb[2][i]});
      if (records_) light_.record[place] = record_of(i);
    }
  }

  SurfaceRecord record_of(int i) {
    const PointSheet& p = work_.points;
    const Scene& scene = tracer_.scene();
    scratch_.rays.start(shader_.camera_ray_of(i));
    const FirstHit hit = shader_.hit(i);
    SurfaceRecord record;
    record.object_id = object_of(scene, hit).id;
    record.distance = p.hits->lambda[i];
    record.doppler = p.doppler[i];
    record.emission_time = scratch_.rays.in(0).at(hit.lambda).t / scene.c;
    record.proper_time = p.proper_time[i] / scene.c;
    record.position = {p.points.position[0][i], p.points.position[1][i], p.points.position[2][i]};
    record.normal = {p.points.normal[0][i], p.points.normal[1][i], p.points.normal[2][i]};
    record.unresolved = hit.hit.unresolved;
    return record;
  }

  const Tracer& tracer_;
  const SheetScene& scene_;
  int eye_;
  bool colours_, records_;
  const std::vector<bool>& relays_;  // whose rays go in sheets
  SheetScratch& work_;
  Scratch& scratch_;
  TileLight& light_;
  SheetShader shader_;
};

}  // namespace

void paint_tile(const Tracer& tracer, const SheetScene& scene, const std::vector<bool>& relays, int eye,
                TileAnswers wanted, SheetScratch& work, Scratch& scratch, TileLight& light) {
  SheetPainter(tracer, scene, relays, eye, wanted, work, scratch, light).paint();
}

}  // namespace backlight
