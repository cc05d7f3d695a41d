// A ball that goes along a path, as a shape: travelling_ball.h for one lane.
#include "travelling_ball.h"

#include <cmath>
#include <utility>

#include "backlight/surface/matter_motion.h"
#include "local_line.h"
#include "shape_table.h"

namespace backlight {
namespace {

using One = Lanes<1>;

TravellingBall ball_of(const Shape& shape) {
  return {shape.values[0], shape.values[1], shape.motion->path()};
}

LaneClock<One> one_lane(const RayClock& clock) {
  return {clock.start, clock.rate};
}

std::string problem_of(const Shape& shape) {
  if (!shape.motion || !shape.motion->ball() || shape.motion->path() == nullptr) return "a path is missing";
  return unless_positive("radius", shape.values[0]);
}

double radius_of(const Shape& shape, const Vec3& factor) {
  return glm::length(shape.motion->farthest() * factor);
}

double extent_of(const Shape& shape, const Extent& e) {
  return glm::dot(shape.motion->farthest(), Vec3{e.x, e.y, e.z});
}

Crossings crossings_of(const Shape& shape, const LocalLine& line, double lambda_min, Wanted /*first*/) {
  const LaneLine<One> lane = backlight::one_lane(line);
  const One along =
      BallSearch<One>(ball_of(shape), lane, one_lane(line.clock)).first(lane.at_lambda(lambda_min), {true});
  Crossings result;
  if (!std::isnan(along.v)) result.add(along.v, 0);
  return result;
}

LocalPoint local_point(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const TravellingPoint<One> found =
      point_of<One>(ball_of(shape), backlight::one_lane(line), one_lane(line.clock), crossing.t);
  LocalPoint point{.position = vec3(found.point.position), .gradient = vec3(found.point.gradient)};
  point.error = found.point.error.v;
  point.is_unit = true;
  point.moves = !travelling_ball_turns(shape);
  point.velocity = vec3(found.velocity);
  return point;
}

void texture_of_motion(const Shape& /*shape*/, int /*part*/, LocalPoint& /*point*/) {}

}  // namespace

const ShapeMethods travelling_ball_methods{.kind = ShapeKind::travelling_ball,
                                           .name = "moving sphere",
                                           .encloses = true,
                                           .problem = problem_of,
                                           .bounding_radius = radius_of,
                                           .half_extent = extent_of,
                                           .crossings = crossings_of,
                                           .point = local_point,
                                           .finder = [](const Shape&) { return RootFinder::taylor; },
                                           .texture = texture_of_motion};

bool travelling_ball_turns(const Shape& shape) {
  return shape.values[2] != 0.0;
}

Shape travelling_ball(double radius, bool turns, std::shared_ptr<const MatterMotion> motion) {
  Shape shape{ShapeKind::travelling_ball, {radius}, {}, {}, {}, {}};
  shape.values[1] = motion && motion->ball() ? motion->ball()->begins : -infinite;
  shape.values[2] = turns ? 1.0 : 0.0;
  shape.motion = std::move(motion);
  return shape;
}

}  // namespace backlight
