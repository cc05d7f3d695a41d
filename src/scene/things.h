// What a scene is made of, as it is called in messages about two things at once.
#pragma once

#include <string>

#include "compile_parts.h"

namespace backlight {

/// Something that was written, and what it is called: "the object 'ball'", "the camera", "this lamp".
struct Thing {
  std::string name;
  Place place;
};

Thing object_thing(const Compilation& c, int object);        ///< index into Scene::objects
Thing light_thing(const Compilation& c, std::size_t light);  ///< index into Scene::lights
Thing camera_thing(const Compilation& c);
Thing background_thing(const Compilation& c);

/// The thing with its line, for a message about another: "the object 'ball' of line 12", or of another file.
std::string beside(const Compilation& c, const Thing& thing, const Thing& subject);

}  // namespace backlight
