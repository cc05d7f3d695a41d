#include "words.h"

#include "backlight/base/diagnostics.h"

namespace backlight {

std::string did_you_mean(const std::string& name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  return nearest.empty() ? std::string() : "did you mean '" + nearest + "'?";
}

std::string listed(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " " + last + " " : ", ";
    text += names[i];
  }
  return text;
}

std::string kind_words(const Node& node) {
  struct Words {
    std::string operator()(const Invalid&) const { return "nothing"; }
    std::string operator()(bool) const { return "true or false"; }
    std::string operator()(double) const { return "a number"; }
    std::string operator()(const std::string&) const { return "a string"; }
    std::string operator()(const Expression&) const { return "a string"; }
    std::string operator()(const NodeArray& a) const { return "an array of " + std::to_string(a.size()); }
    std::string operator()(const NodeTable&) const { return "a table"; }
    std::string operator()(const Date&) const { return "a date or time"; }
  };
  return std::visit(Words{}, node.value);
}

}  // namespace backlight
