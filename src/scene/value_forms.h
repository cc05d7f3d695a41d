// The ways of writing a value: which one a node is, and what they are called.
#pragma once

#include <string>

#include "backlight/scene/description.h"
#include "backlight/scene/keys.h"

namespace backlight {

/// Whether the node's outermost type is that of the form.
bool matches(const ValueForm& form, const Node& node);

/// "a number", "an array of 3 numbers"...
std::string form_words(const ValueForm& form);

}  // namespace backlight
