// The law of the closed forms: closed_forms.h for one lane, as methods of the table of shapes.
#pragma once

#include "closed_forms.h"
#include "shape_table.h"

namespace backlight {

template <class Form>
Crossings crossings_by(const Shape& shape, const LocalLine& line, double /*lambda_min*/, Wanted /*wanted*/) {
  const LaneLine<Lanes<1>> lane = one_lane(line);
  const LaneCrossings<Lanes<1>> found = Form::crossings(shape.values.data(), lane);
  Crossings result;
  for (int i = 0; i < 2; ++i) {
    if (!std::isnan(found.t[i].v)) result.add(found.t[i].v, static_cast<int>(found.part[i].v));
  }
  if constexpr (requires { Form::inside_before(shape.values.data(), lane); }) {
    result.inside_before = Form::inside_before(shape.values.data(), lane).v;
  }
  return result;
}

/// `texture`: fills u and v of a point of a face.
template <class Form, void (*texture)(const Shape&, int part, LocalPoint&)>
LocalPoint point_by(const Shape& shape, const LocalLine& line, const Crossing& crossing) {
  const LaneLocalPoint<Lanes<1>> found = Form::point(shape.values.data(), one_lane(line.at(crossing.t)),
                                                     Lanes<1>(static_cast<double>(crossing.part)));
  LocalPoint point{.position = vec3(found.position), .gradient = vec3(found.gradient)};
  point.error = found.error.v;
  point.is_unit = Form::unit_gradient;
  texture(shape, crossing.part, point);
  return point;
}

/// The row of a shape with a closed form.
template <class Form, void (*texture)(const Shape&, int part, LocalPoint&)>
constexpr ShapeMethods form_methods(ShapeKind kind, const char* name, std::string (*problem)(const Shape&),
                                    double (*bounding_radius)(const Shape&, const Vec3&),
                                    double (*half_extent)(const Shape&, const Extent&),
                                    int (*part_at)(const Shape&, const Vec3&) = nullptr) {
  return {.kind = kind,
          .name = name,
          .encloses = Form::encloses,
          .is_convex = Form::is_convex,
          .is_flat = Form::is_flat,
          .problem = problem,
          .bounding_radius = bounding_radius,
          .half_extent = half_extent,
          .crossings = crossings_by<Form>,
          .point = point_by<Form, texture>,
          .texture = texture,
          .part_at = part_at};
}

}  // namespace backlight
