#include "torus_lanes.h"

namespace backlight {

void torus_roots_baseline(TorusLines& lines, std::size_t count, double major, double minor) {
  torus_roots<Lanes<2>>(lines, count, major, minor);
}

}  // namespace backlight
