// Compiled by the tests of tests/ill_formed/CMakeLists.txt with MIXUP = 0, 1, 2...: only 0 may compile.
#include "backlight/spacetime/transform.h"

using namespace backlight;

void mixup(Event<World> event, Displacement<World> in_world, Displacement<Rest> in_rest,
           NullDirection<Rest> direction, LorentzTransform<Rest, World> rest_from_world,
           DopplerFactor<Camera, Rest> camera_rest, DopplerFactor<Rest, Source> rest_source) {
#if MIXUP == 0
  event + in_world;
  in_world + in_world;
  (void)rest_from_world(in_world);
  camera_rest* rest_source;
  (void)in_rest, (void)direction;
#elif MIXUP == 1
  event + event;
#elif MIXUP == 2
  in_world + in_rest;
#elif MIXUP == 3
  rest_from_world(direction);
#elif MIXUP == 4
  rest_source* camera_rest;
#elif MIXUP == 5
  rest_from_world* rest_from_world;
#else
#error "no such mix-up"
#endif
}
