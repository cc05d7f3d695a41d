// Writes a field of spheres as a scene, for the benchmarks.
//   sphere_field N rest|povray|distinct|circling|FRAMES [MOST_GAMMA]      scene on stdout; FRAMES: so many
//   shared velocities
#include <cstdlib>
#include <iostream>
#include <string>

#include "support/field.h"

int main(int argc, char** argv) {
  using namespace backlight::bench;
  if (argc < 3 || std::atoi(argv[1]) < 1) {
    std::cerr << "sphere_field N rest|povray|distinct|circling|FRAMES [MOST_GAMMA]\n";
    return 2;
  }
  const std::string motion = argv[2];
  FieldRequest request;
  request.spheres = std::atoi(argv[1]);
  if (motion == "distinct") {
    request.motion = FieldMotion::distinct;
  } else if (motion == "circling") {
    request.motion = FieldMotion::circling;
  } else if (motion != "rest" && motion != "povray") {
    request.motion = FieldMotion::shared;
    request.frames = std::atoi(argv[2]);
    if (request.frames < 1) {
      std::cerr << "sphere_field: not a number of frames: " << motion << '\n';
      return 2;
    }
  }
  if (argc > 3) request.most_gamma = std::atof(argv[3]);
  std::cout << (motion == "povray" ? field_for_povray(request) : field_for_backlight(request));
  return std::cout.flush() ? 0 : 4;
}
