// A tile of rays: made, asked what they meet, painted.
#include "backlight/trace/sheet_tracer.h"

#include <algorithm>
#include <utility>

#include "sheet_painter.h"
#include "tile_rays.h"

namespace backlight {
SheetTracer::SheetTracer(const Tracer& tracer, InstructionSet set)
    : tracer_(&tracer),
      instructions_(set),
      scene_(
          std::make_unique<SheetScene>(tracer, tracer.hub(), sheet_kernels(set), SheetScene::From::camera)) {
  const Scene& scene = tracer.scene();
  relays_in_sheets_.assign(scene.frames.size(), false);
  relays_.resize(scene.frames.size());
  if (!tracer.relays().any()) return;
  constexpr std::size_t most = 20000;  // of relays times frames, for the memory
  std::size_t made = 0;
  for (std::size_t i = 0; i < scene.frames.size() && made + scene.frames.size() <= most; ++i) {
    if (!passes_on(scene, scene.frames[i])) continue;
    const Hub& hub = tracer.relays().of(static_cast<int>(i)).hub;
    relays_[i] = std::make_unique<SheetScene>(tracer, hub, sheet_kernels(set), SheetScene::From::relay);
    relays_in_sheets_[i] = relays_[i]->suits_relay();
    made += scene.frames.size();
  }
}

SheetTracer::~SheetTracer() = default;

bool SheetTracer::can_trace(const Scene& scene) {
  return !scene.camera.stereo || scene.camera.lens.projection != Projection::equirectangular;
}

std::unique_ptr<SheetScratch, void (*)(SheetScratch*)> SheetTracer::make_scratch() const {
  return {new SheetScratch(*scene_, tracer_->scene().lights.size(), instructions_),
          [](SheetScratch* work) { delete work; }};
}

void SheetTracer::trace(std::span<const TilePixel> pixels, std::int64_t image_number, int sample, int eye,
                        bool records, SheetScratch& work, Scratch& scratch, TileLight& light) const {
  make_rays(tracer_->scene(), scene_->kernels(), pixels, image_number, sample, work);
  scratch.counts.primary += trace_sheets(pixels.size(), eye, {true, records}, work, scratch, light);
}

void SheetTracer::trace(std::span<const ImagePoint> points, int eye, SheetScratch& work, Scratch& scratch,
                        TileLight& light) const {
  make_rays(tracer_->scene(), scene_->kernels(), points, work);
  scratch.counts.primary += trace_sheets(points.size(), eye, {true, false}, work, scratch, light);
}

void SheetTracer::surfaces(std::span<const ImagePoint> points, int eye, SheetScratch& work, Scratch& scratch,
                           TileLight& light) const {
  make_rays(tracer_->scene(), scene_->kernels(), points, work);
  scratch.counts.data += trace_sheets(points.size(), eye, {false, true}, work, scratch, light);
}

std::size_t SheetTracer::trace_sheets(std::size_t count, int eye, TileAnswers wanted, SheetScratch& work,
                                      Scratch& scratch, TileLight& light) const {
  light.record.assign(wanted.records ? count : 0, SurfaceRecord{});
  std::size_t rays = 0;
  for (const auto& sheet : work.sheets) rays += static_cast<std::size_t>(sheet.rays.count);
  const bool all_shown = rays == count;
  light.covered.assign(count, all_shown ? 1 : 0);
  for (std::vector<double>& channel : light.rgb) {
    channel.resize(count);
    if (!all_shown) std::ranges::fill(channel, 0.0);
  }
  if (rays == 0) return 0;
  for (std::size_t i = 0; !all_shown && i < work.sheets.size(); ++i) {
    const SheetScratch::TileSheet& sheet = work.sheets[i];
    for (int lane = 0; lane < sheet.rays.count; ++lane) {
      light.covered[static_cast<std::size_t>(sheet.place[lane])] = 1;
    }
  }
  work.legs.clear();
  work.put_off.clear();
  find_hits(*tracer_, *scene_, eye, work, scratch);
  paint_tile(*tracer_, *scene_, relays_in_sheets_, eye, wanted, work, scratch, light);
  pass_on(work, scratch, light);
  return rays;
}

// The sums are in the law's order: what is passed on is added last, from the end of the way to its beginning.
void SheetTracer::pass_on(SheetScratch& work, Scratch& scratch, TileLight& light) const {
  if (work.put_off.empty()) return;
  work.legs.swap(work.put_off);
  work.put_off.clear();
  scratch.counts.passed_in_sheets += work.legs.size();
  const auto relay = [](const PutOff& its) { return std::pair(its.frame, its.effects); };
  if (!std::ranges::is_sorted(work.legs, {}, relay)) std::ranges::stable_sort(work.legs, {}, relay);
  TileLight passed;
  for (std::vector<double>& channel : passed.rgb) channel.assign(work.legs.size(), 0.0);
  passed.covered.assign(work.legs.size(), 1);
  for (std::size_t first = 0, next = 0; first < work.legs.size(); first = next) {
    while (next < work.legs.size() && relay(work.legs[next]) == relay(work.legs[first])) ++next;
    const SheetScene& scene = *relays_[static_cast<std::size_t>(work.legs[first].frame)];
    make_rays(first, next - first, work);
    find_hits(*tracer_, scene, 0, work, scratch);
    paint_tile(*tracer_, scene, relays_in_sheets_, 0, {true, false}, work, scratch, passed);
  }
  std::vector<PutOff> legs;
  legs.swap(work.legs);
  pass_on(work, scratch, passed);
  for (std::size_t i = 0; i < legs.size(); ++i)
    light.set_colour(legs[i].place, light.colour(legs[i].place) + passed.colour(i));
  legs.clear();
  work.put_off.swap(legs);  // its memory
}

const char* SheetTracer::instructions() const {
  return scene_->kernels().name;
}

}  // namespace backlight
