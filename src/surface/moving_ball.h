// Where along a line a surface that moves can be.
#pragma once

#include <span>

#include "backlight/surface/matter_motion.h"
#include "backlight/surface/ray_sheet.h"
#include "backlight/surface/surface_set.h"
#include "convex.h"
#include "local_line.h"

namespace backlight {

/// A stretch of the line outside which it is not in the motion's ball: docs/physics.md equation (28). For
/// light and for lines of one moment alike.
Stretch inside_ball(const MatterMotion& motion, const LocalLine& line);

/// The same of each of several lines: of light, from events that are near to each other, by equations (28a)
/// and (29).
void inside_ball(const MatterMotion& motion, const LocalLines& lines, Stretch (&stretches)[LocalLines::most]);

/// A sphere that holds all places at which light can have left the motion's ball that arrives at an event.
BoundingSphere seen_from(const MatterMotion& motion, const Vec3& place, double time);

/// A sphere that holds all places at which light of a flash can meet the motion's ball; about nothing if it
/// meets it later.
BoundingSphere lit_from(const MatterMotion& motion, const LightFlash& flash);

/// What light that arrives at an event meets of the motion's ball: while it does, no farther than `radius`
/// from centre + velocity (t - time). The radius is infinite where that is not known.
struct Passing {
  double time = 0.0;
  double half_time = 0.0;
  Vec3 centre{0.0};
  Vec3 velocity{0.0};
  double radius = 0.0;
};
Passing passing_seen_from(const MatterMotion& motion, const Vec3& place, double time);
/// The same of light that leaves at a flash.
Passing passing_lit_from(const MatterMotion& motion, const LightFlash& flash);
/// The same of several, PassingSheet::most at most, each with its flash.
void passings_lit_from(std::span<const MatterMotion* const> motions, std::span<const LightFlash> flashes,
                       std::span<Passing> passings);
/// What such light meets, in a sphere; about nothing if it does so too late.
BoundingSphere sphere_of(const Passing& passing, const LightFlash& flash);
/// Of a motion about a place.
PassingBall ball_of(const Passing& passing, const Vec3& about);

}  // namespace backlight
