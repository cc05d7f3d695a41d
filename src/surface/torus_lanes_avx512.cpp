// Compiled for AVX-512; to be called only where the processor has it.
#include "torus_lanes.h"

namespace backlight {

void torus_roots_avx512(TorusLines& lines, std::size_t count, double major, double minor) {
  torus_roots<Lanes<8>>(lines, count, major, minor);
}

}  // namespace backlight
