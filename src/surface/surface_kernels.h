// What is computed for many lines at once, in the widths that lanes come in: the same bits from each.
#pragma once

#include "body_lanes.h"
#include "local_lines.h"
#include "mesh_points.h"
#include "mesh_walk.h"
#include "passing_lanes.h"
#include "polynomial_lanes.h"
#include "torus_lanes.h"
#include "walk.h"

namespace backlight {

struct SurfaceKernels {
  void (*local_lines)(const LaneSurface&, LocalLines&);
  void (*torus_roots)(const TorusQuestion&, const LocalLines&, double* roots);
  void (*mesh_crossings)(const MeshQuestion&, const LocalLines&, double* t, double* triangle);
  decltype(&MeshPoints<1>::run) mesh_points;
  PolynomialKernels (*polynomials)(int degree);
  decltype(&Walk<1>::nearest) nearest;
  decltype(&Walk<1>::blocked) blocked;
  decltype(&Walk<1>::points) points;
  void (*find_passings)(PassingSheet&);
  void (*inside_box)(const double (&centre)[3], const double (&half)[3], const LocalLines&, LineStretches&);
  void (*meet_box)(const BodyBox&, const CommonRows&, LineStretches&);
};

template <class V>
SurfaceKernels surface_kernels_of() {
  using W = Walk<V::width>;
  return {.local_lines = bring_lines<V>,
          .torus_roots = TorusLanes<V>::run,
          .mesh_crossings = MeshWalk<V::width>::run,
          .mesh_points = MeshPoints<V::width>::run,
          .polynomials = polynomial_kernels_of<V>,
          .nearest = W::nearest,
          .blocked = W::blocked,
          .points = W::points,
          .find_passings = find_passings<V>,
          .inside_box = inside_box<V>,
          .meet_box = meet_box<V>};
}

SurfaceKernels baseline_surface_kernels();
// To be called only where the processor has these instructions (base/instruction_sets.h).
SurfaceKernels avx2_surface_kernels();
SurfaceKernels avx512_surface_kernels();

/// Those of the widest lanes that this processor is good at, or of fewer.
const SurfaceKernels& surface_kernels(InstructionSet set = InstructionSet::widest);

}  // namespace backlight
