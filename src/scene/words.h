// Phrases that several messages share.
#pragma once

#include <string>
#include <vector>

#include "backlight/scene/description.h"

namespace backlight {

/// "did you mean 'sphere'?", or nothing when no candidate is near.
std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates);

/// "a, b or c".
std::string listed(const std::vector<std::string>& names, const std::string& last = "or");

/// What a value is: "a number", "an array of 2"...
std::string kind_words(const Node& node);

}  // namespace backlight
