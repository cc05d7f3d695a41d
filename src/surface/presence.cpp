#include "presence.h"

#include "surface_point.h"

namespace backlight {

Hit first_present(const PlacedSurface& surface, int index, const LocalLine& line) {
  double from = 0.0;
  for (;;) {
    const Crossings found = crossings(surface.shape, line, from, Wanted::first);
    const Crossing* next = nullptr;
    for (int i = 0; i < found.count && next == nullptr; ++i) {
      if (line.lambda(found.list[i].t) > from) next = &found.list[i];
    }
    if (next == nullptr) return {};
    from = line.lambda(next->t);
    const double time = line.clock.start + next->t * line.clock.rate;
    const bool moves = surface.shape.motion != nullptr || surface.shape.solid != nullptr;
    const SurfacePoint point = moves ? surface_point(surface, line, *next) : SurfacePoint{};
    if (surface.shape.presence->at(point.moves ? point.own_time : time)) {
      return {from, index, next->part, next->unresolved, next->t};
    }
  }
}

}  // namespace backlight
