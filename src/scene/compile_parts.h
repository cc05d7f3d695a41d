// The parts of a scene, each compiled from its tables.
#pragma once

#include "backlight/scene/compile.h"
#include "compiled_parts.h"
#include "materials.h"
#include "motion.h"
#include "values.h"

namespace backlight {

/// What the parts share while one image is compiled.
struct Compilation {
  ImageValues& values;
  const ImageRequest& request;
  ResourceCache& cache;
  Scene& scene;
  Frames& frames;
  CompiledParts& parts;
};

/// The variables of one image, with their derivatives by t. What is wrong with them goes to `diagnostics`.
ImageValues image_values(const Description& description, const ImageRequest& request,
                         Diagnostics& diagnostics);

/// The table of the camera that is asked for, or null, which has been reported.
const Node* find_camera(ImageValues& values, const ImageRequest& request);

void compile_film(Compilation& c);
void compile_camera(Compilation& c);  ///< after the film, whose size the lens takes
void compile_objects(Compilation& c);
void compile_lights(Compilation& c);
void compile_sky(Compilation& c);
void compile_effects(Compilation& c);
/// Warns of light that will pass what a film value can be; once for all images. After all the others, if
/// nothing was wrong.
void foresee_brightness(Compilation& c);

/// Adds an error where the camera is in glass that moves relative to it, or one eye alone is. For a scene
/// that is whole.
void check_camera_in_glass(Compilation& c);

/// Warns of matter that the camera sees in glass relative to which it moves: each pair once. For a scene that
/// is whole.
void warn_of_matter_in_glass(Compilation& c);

/// Adds an error for things that move so fast relative to each other, or so far from the origin, that frames
/// cannot be composed to what is promised. For a scene that is whole.
void check_reach(Compilation& c);

/// Adds a warning for each point lamp that an opaque object hides from all that the camera sees, and for each
/// that lies on a surface. For a scene that is whole.
void warn_of_hidden_lamps(Compilation& c);

}  // namespace backlight
