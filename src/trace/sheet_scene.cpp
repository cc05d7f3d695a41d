#include "sheet_scene.h"

#include <cmath>
#include <limits>

#include "cones.h"
#include "culling.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Of what takes one ray at a time.
constexpr LaneSurface no_lanes{};

// Columns of `count` numbers, and room for a register of any width behind the last.
std::size_t padded(std::size_t count) {
  return (count + 8) / 4 * 4;
}

BoundingSphere bounds_of(const Occupant& occupant, const SurfaceSet& surfaces) {
  if (occupant.surface == Occupant::whole_frame) return surfaces.bounds();
  if (occupant.surface == Occupant::all_bounded) return surfaces.bounds_of_bounded();
  return surfaces.bounds(occupant.surface);
}

}  // namespace

void ConeStore::resize(std::size_t count) {
  const std::size_t column = padded(count);
  numbers_ = std::make_unique_for_overwrite<double[]>(6 * column);
  for (std::size_t i = 0; i < 3; ++i) table_.axis[i] = numbers_.get() + i * column;
  table_.level = numbers_.get() + 3 * column;
  table_.radius = numbers_.get() + 4 * column;
  table_.who = numbers_.get() + 5 * column;
  table_.count = static_cast<int>(count);
}

void LampStore::resize(std::size_t count) {
  const std::size_t column = padded(count);
  numbers_ = std::make_unique_for_overwrite<double[]>(12 * column);
  double* next = numbers_.get();
  for (double** start : {&table_.celerity[0], &table_.celerity[1], &table_.celerity[2], &table_.gamma,
                         &table_.inverse_gamma_plus_one, &table_.speed, &table_.place[0], &table_.place[1],
                         &table_.place[2], &table_.radius, &table_.core, &table_.who}) {
    *start = next;
    next += column;
  }
  table_.count = static_cast<int>(count);
}

Displacement<Camera> eye_offset(const CameraView& camera, int eye) {
  if (eye == 0 || !camera.stereo) return {};
  return {0.0, 0.5 * eye * camera.stereo->separation * camera.lens.right};
}

SheetScene::SheetScene(const Scene& scene, const Hub& hub, const SheetKernels& kernels) : kernels_(&kernels) {
  for (const FrameView& view : hub.frames) {
    one_by_one_.push_back(view.from_camera.is_robust() || view.far != nullptr);
  }
  list_occupants(hub);
  if (scene.camera.stereo) {
    eyes_.push_back(view_of(scene, hub, -1));
    eyes_.push_back(view_of(scene, hub, +1));
  } else {
    eyes_.push_back(view_of(scene, hub, 0));
  }
  lit_in_lanes_.assign(hub.frames.size(), true);
  for (std::size_t i = 0; i < hub.lights.size(); ++i) {
    lamps_.push_back(view_of(scene, hub, i));
    if (scene.lights[i].kind == LightKind::ambient) continue;
    for (std::size_t f = 0; f < hub.frames.size(); ++f) {
      if (!lamps_[i].in_lanes || one_by_one_[f] || hub.lights[i].to_frame[f].is_robust())
        lit_in_lanes_[f] = false;
    }
  }
}

// Trees come behind all surfaces: what they find takes the place of what was found before, where that is
// farther away or, equally far, later in the scene.
void SheetScene::list_occupants(const Hub& hub) {
  std::size_t most = 0;
  for (const int frame : hub.occupied) {
    most += hub.frames[static_cast<std::size_t>(frame)].scene->surfaces->size();
  }
  lanes_.reserve(most);  // the occupants point into it
  std::vector<Occupant> trees;
  for (const int frame : hub.occupied) {
    const SurfaceSet& surfaces = *hub.frames[static_cast<std::size_t>(frame)].scene->surfaces;
    if (one_by_one(frame)) {
      occupants_.push_back({frame, Occupant::whole_frame, &no_lanes});
      occluders_.push_back({frame, Occupant::whole_frame, &no_lanes});
      continue;
    }
    const bool camera_tree = surfaces.asked_one_by_one() > camera_tree_from;
    const bool light_tree =
        camera_tree || (surfaces.size() > tree_from && std::isfinite(surfaces.bounds().radius));
    const Occupant tree{frame, Occupant::all_bounded, &no_lanes, static_cast<int>(occupants_.size())};
    if (camera_tree) trees.push_back(tree);
    if (light_tree) occluders_.push_back(tree);
    for (int s = 0; s < static_cast<int>(surfaces.size()); ++s) {
      lanes_.push_back(surfaces.lane_surface(s));
      const bool bounded = std::isfinite(surfaces.bounds(s).radius);
      const bool own_occluder = surfaces.casts_shadow(s) && !(light_tree && bounded);
      const int occluder = own_occluder ? static_cast<int>(occluders_.size()) : -1;
      occupants_.push_back({frame, s, &lanes_.back(), 0, camera_tree && bounded, occluder});
      if (own_occluder) occluders_.push_back({frame, s, &lanes_.back()});
    }
  }
  occupants_.insert(occupants_.end(), trees.begin(), trees.end());
}

EyeView SheetScene::view_of(const Scene& scene, const Hub& hub, int eye) const {
  EyeView result;
  const Displacement<Camera> offset = eye_offset(scene.camera, eye);
  for (const FrameView& view : hub.frames) {
    LaneFrame frame;
    frame.from_camera = lane_motion(view.from_camera);
    const Event<Rest> event = eye_event(view, scene.camera, eye);
    for (int i = 0; i < 3; ++i) frame.origin[i] = event.x[i];
    frame.time = event.t;
    result.frames.push_back(frame);
  }
  for (int delayed = 0; delayed < 2; ++delayed) {
    ConeStore& store = result.cones[static_cast<std::size_t>(delayed)];
    store.resize(occupants_.size());
    ConeTable& table = store.table();
    table.count = 0;
    for (std::size_t i = 0; i < occupants_.size(); ++i) {
      const Occupant& occupant = occupants_[i];
      if (occupant.in_tree) continue;
      const FrameView& view = hub.frames[static_cast<std::size_t>(occupant.frame)];
      const double* o = result.frames[static_cast<std::size_t>(occupant.frame)].origin;
      const Vec3 origin{o[0], o[1], o[2]};
      LaneCone cone;
      cone.level = -infinity;
      double radius = 0.0;
      if (occupant.surface == Occupant::whole_frame) {
        if (view.far && view.far->unbounded.empty()) {
          if (delayed != 0) cone = cone_of(*view.far, view.far->bounds, offset);
          radius = view.far->bounds.radius * (1.0 + 1e-9);
        }
      } else {
        const BoundingSphere sphere = bounds_of(occupant, *view.scene->surfaces);
        if (std::isfinite(sphere.radius)) {
          cone = delayed != 0 ? cone_of(view, origin, sphere) : cone_of_now(view, origin, sphere);
          radius = sphere.radius;
        }
      }
      const auto row = static_cast<std::size_t>(table.count++);
      for (int k = 0; k < 3; ++k) table.axis[k][row] = cone.axis[k];
      table.level[row] = cone.level;
      table.radius[row] = radius;
      table.who[row] = static_cast<double>(i);
    }
  }
  return result;
}

LampView SheetScene::view_of(const Scene& scene, const Hub& hub, std::size_t light) const {
  LampView result;
  const Light& lamp = scene.lights[light];
  if (lamp.kind == LightKind::ambient) return result;
  result.in_lanes = !one_by_one(lamp.frame);
  for (const auto& to_frame : hub.lights[light].to_frame) result.to_frame.push_back(lane_motion(to_frame));

  const Vec3 from = hub.frames[static_cast<std::size_t>(lamp.frame)].camera_event.x;
  const Vec3 way = lamp.kind == LightKind::point ? lamp.position - from : Vec3{0.0};
  result.bounded.resize(occluders_.size());
  LampTable& table = result.bounded.table();
  table.count = 0;
  table.moving = false;
  for (std::size_t i = 0; i < occluders_.size(); ++i) {
    const Occupant& occluder = occluders_[i];
    const FrameView& view = hub.frames[static_cast<std::size_t>(occluder.frame)];
    const SurfaceSet& surfaces = *view.scene->surfaces;
    const BoundingSphere sphere = bounds_of(occluder, surfaces);
    if (!std::isfinite(sphere.radius)) {
      result.unbounded.push_back(static_cast<int>(i));
      continue;
    }
    const auto& motion = hub.lights[light].to_frame[static_cast<std::size_t>(occluder.frame)];
    const Vec3& w = motion.celerity();
    const Vec3 here = glm::transpose(motion.rotation()) * (view.camera_event.x - sphere.centre);
    const Vec3 place = here + way + (glm::dot(w, way) * motion.inverse_gamma_plus_one()) * w;
    const auto j = static_cast<std::size_t>(table.count++);
    for (int k = 0; k < 3; ++k) {
      table.celerity[k][j] = w[k];
      table.place[k][j] = place[k];
    }
    table.gamma[j] = motion.gamma();
    table.inverse_gamma_plus_one[j] = motion.inverse_gamma_plus_one();
    table.speed[j] = glm::length(w) * (1.0 + 1e-15);
    table.moving = table.moving || table.speed[j] > 0.0;
    // Room for the rounding of `place`, and of the points that shadow rays start from.
    const double room =
        1e-13 * (glm::length(here) + glm::length(view.camera_event.x) + glm::length(sphere.centre) +
                 2.0 * motion.gamma() * (glm::length(way) + glm::length(from) + glm::length(lamp.position)));
    table.radius[j] = sphere.radius * (1.0 + 1e-11) + room;
    const bool is_ball = occluder.lanes->kind == LaneSurface::Kind::sphere && occluder.lanes->aligned;
    table.core[j] = is_ball && !motion.is_robust() ? sphere.radius * (1.0 - 1e-11) - room : 0.0;
    table.who[j] = static_cast<double>(i);
  }
  return result;
}

}  // namespace backlight
