#include "sheet_scene.h"

#include <cmath>
#include <limits>

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

void set(LaneCone& cone, const Vec3& axis, double level) {
  for (int i = 0; i < 3; ++i) cone.axis[i] = axis[i];
  cone.level = level;
}

// Equation (15) for a sphere about `centre` in this frame.
LaneCone cone_of(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere) {
  LaneCone cone;
  cone.level = -infinity;
  const auto& motion = view.from_camera;
  const Vec3 turned = glm::transpose(motion.rotation()) * (origin - sphere.centre);
  const Vec3& w = motion.celerity();
  const double square = glm::dot(turned, turned) - sphere.radius * sphere.radius;
  if (!(square > 0.0) || !std::isfinite(square)) return cone;  // the eye is inside
  const double q = std::sqrt(square);
  const double p = glm::dot(turned, w);
  const double level = q * motion.gamma() + p;
  // Room for some forty roundings of numbers of size γ|x'|, here and where the ray is boosted.
  const double room = motion.gamma() * (1e-13 * (q + sphere.radius) + 1e-14 * glm::length(origin));
  set(cone, -turned - (p * motion.inverse_gamma_plus_one() + q) * w, level - room);
  return cone;
}

// The same in a frame of large γ, from the matrix of Λ in extended precision: n·m >= h with
// m_j = q Λ_0j - Σ x'_i Λ_ij, h = q Λ_00 - Σ x'_i Λ_i0.
LaneCone cone_of(const FarView& far, const Displacement<Camera>& offset) {
  LaneCone cone;
  cone.level = -infinity;
  const ExtendedEvent moved = far.from_camera({Extended(offset.t), ExtendedVec3{offset.x}});
  const ExtendedVec3 place = far.camera_event.x + moved.x - ExtendedVec3{far.bounds.centre};
  const double size = glm::length(far.bounds.centre);
  const Extended radius(far.bounds.radius * (1.0 + 1e-9) + 1e-12 * size);
  const Extended square = dot(place, place) - radius * radius;
  if (!(double(square) > 0.0)) return cone;
  const Extended q = sqrt(square);
  const auto row = [&](const ExtendedEvent& column) { return q * column.t - dot(place, column.x); };
  const Extended level = row(far.from_camera({Extended(1.0), {}}));
  Vec3 axis;
  axis.x = double(row(far.from_camera({Extended(0.0), {Extended(1.0), Extended(0.0), Extended(0.0)}})));
  axis.y = double(row(far.from_camera({Extended(0.0), {Extended(0.0), Extended(1.0), Extended(0.0)}})));
  axis.z = double(row(far.from_camera({Extended(0.0), {Extended(0.0), Extended(0.0), Extended(1.0)}})));
  set(cone, axis, double(level) - 1e-13 * (std::abs(double(level)) + glm::length(axis)));
  return cone;
}

// Without light delay rays are straight lines of one moment of the camera's: the contracted sphere is inside
// a sphere of its rest size.
LaneCone cone_of_now(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere) {
  LaneCone cone;
  cone.level = -infinity;
  const auto& motion = view.from_camera;
  const Vec3 turned = glm::transpose(motion.rotation()) * (sphere.centre - origin);
  const Vec3& w = motion.celerity();
  const double along = glm::dot(turned, w);
  const Vec3 now = turned - (along * motion.inverse_gamma_plus_one() / motion.gamma()) * w;
  const double radius = sphere.radius + 1e-12 * motion.gamma() * glm::length(turned);
  const double square = glm::dot(now, now) - radius * radius;
  if (!(square > 0.0) || !std::isfinite(square)) return cone;
  set(cone, now, std::sqrt(square) * (1.0 - 1e-13));
  return cone;
}

BoundingSphere bounds_of(const Occupant& occupant, const SurfaceSet& surfaces) {
  if (occupant.surface == Occupant::whole_frame) return surfaces.bounds();
  if (occupant.surface == Occupant::all_bounded) return surfaces.bounds_of_bounded();
  return surfaces.bounds(occupant.surface);
}

}  // namespace

void ConeStore::resize(std::size_t count) {
  const std::size_t column = padded(count);
  numbers_ = std::make_unique_for_overwrite<double[]>(5 * column);
  who_ = std::make_unique_for_overwrite<int[]>(column);
  for (std::size_t i = 0; i < 3; ++i) table_.axis[i] = numbers_.get() + i * column;
  table_.level = numbers_.get() + 3 * column;
  table_.radius = numbers_.get() + 4 * column;
  table_.who = who_.get();
  table_.count = static_cast<int>(count);
}

void LampStore::resize(std::size_t count) {
  const std::size_t column = padded(count);
  numbers_ = std::make_unique_for_overwrite<double[]>(11 * column);
  who_ = std::make_unique_for_overwrite<int[]>(column);
  double* next = numbers_.get();
  for (double** start : {&table_.celerity[0], &table_.celerity[1], &table_.celerity[2], &table_.gamma,
                         &table_.inverse_gamma_plus_one, &table_.speed, &table_.place[0], &table_.place[1],
                         &table_.place[2], &table_.radius, &table_.core}) {
    *start = next;
    next += column;
  }
  table_.who = who_.get();
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
      occupants_.push_back({frame, s, &lanes_.back(), 0, camera_tree && bounded});
      if (!(light_tree && bounded)) occluders_.push_back({frame, s, &lanes_.back()});
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
    Event<Rest> event = view.camera_event;
    if (eye != 0) {
      const Displacement<Rest> moved = view.from_camera(offset);
      event.x += moved.x;
      event.t += moved.t;
    }
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
        if (view.far && delayed != 0) cone = cone_of(*view.far, offset);
        if (view.far) radius = view.far->bounds.radius * (1.0 + 1e-9);
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
      table.who[row] = static_cast<int>(i);
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
    table.who[j] = static_cast<int>(i);
  }
  return result;
}

}  // namespace backlight
