#include "backlight/trace/trace_strategy.h"

#include <cmath>

#include "backlight/trace/sheet_tracer.h"
#include "culling.h"
#include "sheet_scene.h"

namespace backlight {
namespace {

// Counts what each occupant is.
CullingChoice counted(const std::vector<Occupant>& occupants, const Hub& hub) {
  CullingChoice choice;
  for (const Occupant& occupant : occupants) {
    const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(occupant.frame)].scene->surfaces;
    if (occupant.in_tree) continue;
    if (occupant.surface < 0) {
      ++choice.trees;
    } else if (std::isfinite(surfaces.bounds(occupant.surface).radius)) {
      ++choice.surfaces;
    } else {
      ++choice.unbounded;
    }
  }
  return choice;
}

CullingChoice one_by_one(const Hub& hub) {
  CullingChoice choice{"one search per frame", 0, 0, 0};
  choice.trees = hub.occupied.size();
  return choice;
}

CullingChoice for_light(const Light& light, bool in_lanes, const CullingChoice& occluders) {
  CullingChoice choice;
  if (!throws_shadows(light)) return choice;
  choice = occluders;
  if (!in_lanes) {
    choice.method = "one ray at a time";
  } else if (light.kind == LightKind::distant) {
    choice.method = "shadow cylinders per sheet";
  } else {
    const std::size_t occluders_of_lists = choice.surfaces + choice.trees;
    choice.method = occluders_of_lists >= packets_from     ? "light-sky cones per sorted packet"
                    : occluders_of_lists >= tile_list_from ? "light-sky cones per tile"
                                                           : "light-sky cones per sheet";
  }
  return choice;
}

TraceStrategy of_sheets(const Scene& scene, const Hub& hub, const SheetScene& sheets) {
  TraceStrategy strategy;
  strategy.rays = "sheets of " + std::to_string(sheet_size) + " rays";
  strategy.camera = counted(sheets.occupants(), hub);
  strategy.camera.method = "camera-sky cones per tile";
  const CullingChoice occluders = counted(sheets.occluders(), hub);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    strategy.shadows.push_back(for_light(scene.lights[i], sheets.lamp(i).in_lanes, occluders));
  }
  return strategy;
}

}  // namespace

TraceStrategy Tracer::strategy() const {
  TraceStrategy strategy;
  strategy.rays = "one ray at a time";
  strategy.camera = one_by_one(hub_);
  for (const Light& light : scene_->lights) {
    strategy.shadows.push_back(throws_shadows(light) ? one_by_one(hub_) : CullingChoice{});
  }
  return strategy;
}

TraceStrategy SheetTracer::strategy() const {
  return of_sheets(tracer_->scene(), tracer_->hub(), *scene_);
}

TraceStrategy trace_strategy(const Scene& scene) {
  const Tracer tracer(scene, 0);
  if (!SheetTracer::can_trace(scene)) return tracer.strategy();
  return SheetTracer(tracer, InstructionSet::baseline).strategy();
}

std::string in_words(const CullingChoice& choice) {
  if (choice.method.empty()) return "none";
  std::string words = choice.method;
  const auto add = [&](std::size_t count, const char* one, const char* many) {
    if (count == 0) return;
    words += words == choice.method ? ": " : ", ";
    words += std::to_string(count) + ' ' + (count == 1 ? one : many);
  };
  add(choice.surfaces, "surface", "surfaces");
  add(choice.trees, "tree of a frame", "trees of frames");
  add(choice.unbounded, "unbounded", "unbounded");
  return words;
}

}  // namespace backlight
