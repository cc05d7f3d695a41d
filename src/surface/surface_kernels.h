// What is computed for many lines at once, in the widths that lanes come in: the same bits from each.
#pragma once

#include "local_lines.h"
#include "polynomial_lanes.h"
#include "torus_lanes.h"

namespace backlight {

struct SurfaceKernels {
  void (*local_lines)(const LanePlacement&, LocalLines&);
  void (*torus_roots)(const TorusQuestion&, const LocalLines&, double* roots);
  PolynomialKernels (*polynomials)(int degree);
};

template <class V>
SurfaceKernels surface_kernels_of() {
  return {bring_lines<V>, TorusLanes<V>::run, polynomial_kernels_of<V>};
}

SurfaceKernels baseline_surface_kernels();
// To be called only where the processor has these instructions (base/instruction_sets.h).
SurfaceKernels avx2_surface_kernels();
SurfaceKernels avx512_surface_kernels();

/// Those of the widest lanes that this processor is good at.
const SurfaceKernels& surface_kernels();

}  // namespace backlight
