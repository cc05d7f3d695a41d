#include "sheet_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "backlight/trace/visibility.h"
#include "cones.h"
#include "glass.h"

namespace backlight {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_extended(const FrameView& view) {
  return view.from_camera.is_robust() || view.far != nullptr;
}

// Whether the light of the object's points is not for lanes: a material of it is another one at each time, or
// passes light on.
bool is_for_the_law(const Scene& scene, const Object& object) {
  const auto its = [&](int material) {
    const Material& of = scene.materials[static_cast<std::size_t>(material)];
    return of.in_time != nullptr || passes_on(of);
  };
  return its(object.material) || std::ranges::any_of(object.member_materials, its);
}

}  // namespace

Displacement<Camera> eye_offset(const CameraView& camera, int eye) {
  if (eye == 0 || !camera.stereo) return {};
  return {0.0, 0.5 * eye * camera.stereo->separation * camera.lens.right};
}

SheetScene::SheetScene(const Tracer& tracer, const Hub& hub, const SheetKernels& kernels, From from)
    : kernels_(&kernels), hub_(&hub) {
  const Scene& scene = tracer.scene();
  list_entries(scene, from);
  if (from == From::relay) {
    for (const Entry& entry : entries_) {
      const BoundingSphere sphere = surfaces(entry).bounds();
      balls_.push_back({{sphere.centre.x, sphere.centre.y, sphere.centre.z}, sphere.radius});
    }
  }
  if (scene.camera.stereo && from == From::camera) {
    eyes_.push_back(view_of(scene, -1));
    eyes_.push_back(view_of(scene, +1));
  } else {
    eyes_.push_back(view_of(scene, 0));
  }
  // Lanes do not know what glass leaves of a lamp's light.
  lit_in_lanes_.assign(hub.frames.size(), scene.lights.empty() || tracer.shading().glass->empty());
  for (std::size_t i = 0; i < hub.lights.size(); ++i) {
    lamps_.push_back(view_of(scene, i));
    if (scene.lights[i].kind == LightKind::ambient) continue;
    lamps_move_ = lamps_move_ || scene.lights[i].motion;
    for (std::size_t f = 0; f < hub.frames.size(); ++f) {
      if (!lamps_[i].in_lanes || is_extended(hub.frames[f]) || hub.lights[i].to_frame[f].is_robust())
        lit_in_lanes_[f] = false;
    }
  }
}

bool SheetScene::suits_relay() const {
  return std::ranges::none_of(entries_, &Entry::extended);
}

void SheetScene::list_entries(const Scene& scene, From from) {
  for (const int frame : hub_->occupied) {
    const FrameView& view = hub_->frames[static_cast<std::size_t>(frame)];
    const SurfaceSet& surfaces = *view.scene->surfaces;
    const int first = static_cast<int>(numbered_.size());
    Entry entry{frame, first, is_extended(view), false, false};
    entry.travels = from == From::camera && !entry.extended && surfaces.any_travels();
    // Solids of several materials are a group each: which one a point has is not known before.
    std::unordered_map<int, int> group_of[4];
    for (int s = 0; s < static_cast<int>(surfaces.size()); ++s) {
      const Object& object = object_of(scene, frame, s);
      const int key = object.member_materials.empty() ? object.material : -1 - object.id;
      const Group its{is_for_the_law(scene, object), surfaces.moves(s)};
      const auto [group, is_new] = group_of[(its.singly ? 1 : 0) + (its.moves ? 2 : 0)].try_emplace(
          key, static_cast<int>(groups_.size()));
      if (is_new) groups_.push_back(its);
      numbered_.push_back({static_cast<int>(entries_.size()), group->second});
      entry.casts_shadows = entry.casts_shadows || surfaces.casts_shadow(s);
    }
    entries_.push_back(entry);
  }
}

EyeView SheetScene::view_of(const Scene& scene, int eye) const {
  EyeView result;
  const Displacement<Camera> offset = eye_offset(scene.camera, eye);
  for (const FrameView& view : hub_->frames) {
    LaneFrame frame;
    frame.from_camera = lane_motion(view.from_camera);
    const Event<Rest> event = eye_event(view, scene.camera, eye);
    for (int i = 0; i < 3; ++i) frame.origin[i] = event.x[i];
    frame.time = event.t;
    result.frames.push_back(frame);
  }
  for (const Entry& entry : entries_) {
    const LaneFrame& frame = result.frames[static_cast<std::size_t>(entry.frame)];
    result.passings.push_back(entry.travels
                                  ? surfaces(entry).passing_seen_from(
                                        {frame.origin[0], frame.origin[1], frame.origin[2]}, frame.time)
                                  : PassingBall{});
  }
  for (int delayed = 0; delayed < 2; ++delayed) {
    ConeStore& store = result.cones[static_cast<std::size_t>(delayed)];
    store.resize(entries_.size());
    ConeTable& table = store.table();
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const Entry& entry = entries_[i];
      const FrameView& view = hub_->frames[static_cast<std::size_t>(entry.frame)];
      const double* o = result.frames[static_cast<std::size_t>(entry.frame)].origin;
      const LaneFrame& eye_frame = result.frames[static_cast<std::size_t>(entry.frame)];
      const BoundingSphere sphere = delayed != 0 && !entry.extended
                                        ? surfaces(entry).seen_from({o[0], o[1], o[2]}, eye_frame.time)
                                        : surfaces(entry).bounds();
      LaneCone cone;
      cone.level = -infinity;
      double radius = 0.0;
      if (std::isfinite(sphere.radius) && (!entry.extended || view.far)) {
        radius = sphere.radius * (entry.extended ? 1.0 + 1e-9 : 1.0);
        if (!entry.extended) {
          const Vec3 origin{o[0], o[1], o[2]};
          cone = delayed != 0 ? cone_of(view, origin, sphere) : cone_of_now(view, origin, sphere);
        } else if (delayed != 0) {
          cone = cone_of(*view.far, sphere, offset);
        }
      }
      for (int k = 0; k < 3; ++k) table.axis[k][i] = cone.axis[k];
      table.level[i] = cone.level;
      table.radius[i] = radius;
      table.who[i] = static_cast<double>(i);
    }
  }
  return result;
}

LampView SheetScene::view_of(const Scene& scene, std::size_t light) const {
  LampView result;
  const Light& lamp = scene.lights[light];
  if (lamp.kind == LightKind::ambient) return result;
  const FrameView& lamp_frame = hub_->frames[static_cast<std::size_t>(lamp.frame)];
  result.in_lanes = !is_extended(lamp_frame);
  for (const auto& to_frame : hub_->lights[light].to_frame) result.to_frame.push_back(lane_motion(to_frame));

  result.bounded.resize(entries_.size());
  LampTable& table = result.bounded.table();
  table.count = 0;
  table.moving = false;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (!entry.casts_shadows) continue;
    const BoundingSphere sphere = surfaces(entry).bounds();
    const bool may_travel = entry.travels && lamp.kind == LightKind::point && !lamp.motion &&
                            result.in_lanes && hub_->lights[light].retarded_shadows;
    result.any_travels = result.any_travels || may_travel;
    if (!std::isfinite(sphere.radius) || lamp.motion) {
      (may_travel ? result.travellers : result.unbounded).push_back(static_cast<int>(i));
      continue;
    }
    put(scene, light, entry, sphere, table, table.count);
    const auto j = static_cast<std::size_t>(table.count++);
    table.moving = table.moving || table.speed[j] > 0.0;
    table.who[j] = static_cast<double>(i);
  }
  for (const int i : result.travellers) {
    const auto at = static_cast<std::size_t>(entry(i).frame);
    table.moving = table.moving || !hub_->lights[light].to_frame[at].is_identity();
  }
  return result;
}

void SheetScene::put(const Scene& scene, std::size_t light, const Entry& entry, const BoundingSphere& sphere,
                     LampTable& table, int row) const {
  const Light& lamp = scene.lights[light];
  const Vec3 from = hub_->frames[static_cast<std::size_t>(lamp.frame)].camera_event.x;
  const Vec3 way = lamp.kind == LightKind::point ? lamp.position - from : Vec3{0.0};
  const FrameView& view = hub_->frames[static_cast<std::size_t>(entry.frame)];
  const auto& motion = hub_->lights[light].to_frame[static_cast<std::size_t>(entry.frame)];
  const Vec3& w = motion.celerity();
  const Vec3 here = glm::transpose(motion.rotation()) * (view.camera_event.x - sphere.centre);
  const Vec3 place = here + way + (glm::dot(w, way) * motion.inverse_gamma_plus_one()) * w;
  const auto j = static_cast<std::size_t>(row);
  for (int k = 0; k < 3; ++k) {
    table.celerity[k][j] = w[k];
    table.place[k][j] = place[k];
  }
  table.gamma[j] = motion.gamma();
  table.inverse_gamma_plus_one[j] = motion.inverse_gamma_plus_one();
  table.speed[j] = glm::length(w) * (1.0 + 1e-15);
  // Room for the rounding of `place`, and of the points that shadow rays start from.
  const double room =
      1e-13 * (glm::length(here) + glm::length(view.camera_event.x) + glm::length(sphere.centre) +
               2.0 * motion.gamma() * (glm::length(way) + glm::length(from) + glm::length(lamp.position)));
  table.radius[j] = sphere.radius * (1.0 + 1e-11) + room;
  const double opaque = surfaces(entry).size() == 1 ? surfaces(entry).opaque_radius(0) : 0.0;
  table.core[j] =
      opaque > 0.0 && !entry.extended && !motion.is_robust() ? opaque * (1.0 - 1e-11) - room : 0.0;
}

LightFlash SheetScene::flash_of(const Scene& scene, std::size_t light, const Entry& its,
                                const Bundle& bundle) const {
  const Light& lamp = scene.lights[light];
  const FrameView& view = hub_->frames[static_cast<std::size_t>(its.frame)];
  const auto& motion = hub_->lights[light].to_frame[static_cast<std::size_t>(its.frame)];
  const Vec3 way = lamp.position - hub_->frames[static_cast<std::size_t>(lamp.frame)].camera_event.x;
  const Displacement<Rest> ahead = motion(Displacement<Source>{bundle.time, way});
  const double spread = motion.gamma() + glm::length(motion.celerity());
  const double size = glm::length(view.camera_event.x) + spread * (std::abs(bundle.time) + glm::length(way));
  const double aside = scene.camera.stereo ? scene.camera.stereo->separation : 0.0;
  LightFlash flash;
  flash.place = view.camera_event.x + ahead.x;
  flash.time = view.camera_event.t + ahead.t;
  flash.apart = spread * bundle.half_time + 1e-13 * (size + std::abs(view.camera_event.t));
  flash.until = view.camera_event.t + view.from_camera.gamma() * aside + flash.apart;
  return flash;
}

void SheetScene::add_travellers(const Scene& scene, std::size_t light, std::span<const int> indices,
                                const Bundle& bundle, LampTable& table,
                                std::span<PassingBall> passings) const {
  constexpr std::size_t most = SurfaceSet::most_lit;
  std::array<const SurfaceSet*, most> sets;
  std::array<LightFlash, most> flashes;
  std::array<BoundingSphere, most> spheres;
  std::array<PassingBall, most> balls;
  while (!indices.empty()) {
    const std::span<const int> some = indices.first(std::min(most, indices.size()));
    indices = indices.subspan(some.size());
    for (std::size_t i = 0; i < some.size(); ++i) {
      sets[i] = &surfaces(entry(some[i]));
      flashes[i] = flash_of(scene, light, entry(some[i]), bundle);
    }
    SurfaceSet::lit_from({sets.data(), some.size()}, {flashes.data(), some.size()},
                         {spheres.data(), some.size()}, {balls.data(), some.size()});
    for (std::size_t i = 0; i < some.size(); ++i) {
      if (spheres[i].radius < 0.0) continue;
      passings[static_cast<std::size_t>(some[i])] = balls[i];
      put(scene, light, entry(some[i]), spheres[i], table, table.count);
      table.who[table.count++] = static_cast<double>(some[i]);
    }
  }
}

}  // namespace backlight
