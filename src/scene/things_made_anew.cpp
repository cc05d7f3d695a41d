#include "things_made_anew.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "backlight/scene/keys.h"

namespace backlight {
namespace {

class Search {
 public:
  explicit Search(const Description& description) : description_(description) {}

  struct Found {
    const Key* key;
    Place place;
    std::size_t more = 0;  // places with the same key
  };
  [[nodiscard]] const std::vector<Found>& found() const { return found_; }

  // `of_a_thing`: what would be the picture's, such as the keys of a rocket, is a thing's here.
  void table(const Node& node, const KeyTable& keys, bool of_a_thing = false) {
    if (node.table() == nullptr) return;
    const KeyTable* variant = variant_of(node, keys);
    for (const Entry& entry : *node.table()) {
      const Key* key = find_key(keys, entry.name);
      if (key == nullptr && variant != nullptr) key = find_key(*variant, entry.name);
      if (key != nullptr) value(entry.node, *key, of_a_thing);
    }
  }

 private:
  static const KeyTable* variant_of(const Node& node, const KeyTable& keys) {
    if (keys.selector.empty()) return nullptr;
    const Entry* written = find(node, keys.selector);
    if (written != nullptr) return written->node.text() ? find_variant(keys, *written->node.text()) : nullptr;
    const auto* usual = std::get_if<std::string>(&find_key(keys, keys.selector)->value);
    return usual != nullptr ? find_variant(keys, *usual) : nullptr;
  }

  void value(const Node& node, const Key& key, bool of_a_thing) {
    const bool anew = key.clock == Clock::anew;
    for (const ValueForm& form : key.forms) {
      switch (form.kind) {
        case ValueKind::table:
          table(node, *find_table(form.table), anew);
          break;
        case ValueKind::tables:
          if (node.array() == nullptr) break;
          for (const Node& element : *node.array()) table(element, *find_table(form.table));
          break;
        case ValueKind::named_tables:
          if (node.table() == nullptr) break;
          for (const Entry& entry : *node.table()) table(entry.node, *find_table(form.table));
          break;
        default:
          break;
      }
    }
    if (!anew && !(of_a_thing && key.clock == Clock::image)) return;
    if (const Node* number = depending(node)) note(key, number->place);
  }

  // The first number that depends on t, or null.
  const Node* depending(const Node& node) const {
    if (const auto* expression = std::get_if<Expression>(&node.value))
      return description_.depends_on_t(*expression) ? &node : nullptr;
    if (node.array() == nullptr) return nullptr;
    for (const Node& element : *node.array()) {
      if (const Node* number = depending(element)) return number;
    }
    return nullptr;
  }

  void note(const Key& key, const Place& place) {
    const auto known = std::ranges::find(found_, &key, &Found::key);
    if (known != found_.end()) {
      ++known->more;
    } else {
      found_.push_back({&key, place});
    }
  }

  const Description& description_;
  std::vector<Found> found_;
};

}  // namespace

void warn_of_things_made_anew(const Description& description, Diagnostics& diagnostics) {
  Search search(description);
  search.table(description.root, *find_table(""));
  for (const Search::Found& found : search.found()) {
    std::string others = found.more > 0 ? " (and in " + std::to_string(found.more) + " more place" : "";
    if (found.more > 0) others += found.more > 1 ? "s)" : ")";
    std::string hint = "image_time instead of t says just that, without a warning";
    if (!found.key->physically.empty()) hint = std::string(found.key->physically) + "; " + hint;
    diagnostics.warning(
        description.span(found.place),
        "'" + std::string(found.key->name) +
            "' depends on t, and is evaluated anew for each image: everywhere at once, without "
            "the delay of light" +
            others,
        std::move(hint));
  }
}

}  // namespace backlight
