#include "source_files.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <memory>
#include <unordered_map>
#include <utility>

#include "backlight/base/files.h"
#include "toml_text.h"

namespace backlight {
namespace {

constexpr std::size_t deepest_include = 64;

// What an included file gives to the scene, and in which form.
constexpr std::array<std::string_view, 3> merged_tables{"params", "frame", "material"};
constexpr std::array<std::string_view, 2> merged_lists{"light", "object"};

bool is_merged(std::string_view name) {
  const auto among = [&](const auto& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  return among(merged_tables) || among(merged_lists);
}

// The same file is recognised whichever way it is reached.
std::filesystem::path identity_of(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path.lexically_normal() : canonical;
}

}  // namespace

bool SourceFiles::read(const std::filesystem::path& path) {
  auto text = read_file(path);
  if (!text.ok()) {
    diagnostics_.error({}, text.error());
    return false;
  }
  way_.push_back({path.string(), identity_of(path)});
  take(text.value(), path.string(), path.parent_path());
  way_.pop_back();
  return true;
}

void SourceFiles::take(const std::string& text, const std::string& name,
                       const std::filesystem::path& folder) {
  if (way_.empty()) way_.push_back({name, identity_of(folder / name)});
  read_.insert(way_.back().identity);
  description_.root = parse(text, name, folder);
}

std::string SourceFiles::sha256() {
  return to_hex(digest_.finish());
}

Node SourceFiles::parse(const std::string& text, const std::string& name,
                        const std::filesystem::path& folder) {
  const std::size_t source = description_.sources.size();
  const std::string plain(without_byte_order_mark(text));
  description_.sources.push_back(std::make_shared<const SourceText>(SourceText{name, plain}));
  description_.folders.push_back(folder);
  digest_.update(text);
  if (const std::string fault = fault_of_encoding(text); !fault.empty()) {
    is_toml_ = false;
    SourceSpan whole_file;
    whole_file.source = description_.sources.back();
    diagnostics_.error(whole_file, fault);
    return Node{NodeTable{}, {}};
  }
  auto parsed = parse_toml(plain, static_cast<std::uint32_t>(source), description_.memory.get());
  if (const auto* error = std::get_if<TomlError>(&parsed)) {
    is_toml_ = false;
    diagnostics_.error(description_.span(error->place), error->message);
    return Node{NodeTable{}, {}};
  }
  Node root = std::get<Node>(std::move(parsed));
  merge_includes(root, source);
  return root;
}

// The included files' tables go before the file's own, so that objects are numbered in the order of reading.
void SourceFiles::merge_includes(Node& root, std::size_t source) {
  const Entry* includes = find(root, "include");
  if (includes == nullptr) return;
  Node merged{NodeTable{}, root.place};
  if (const NodeArray* paths = includes->node.array()) {
    for (const Node& path : *paths) {
      if (path.text() != nullptr) include(path, source, merged);  // otherwise the check of types reports it
    }
  }
  append(merged, std::move(root));
  root = std::move(merged);
}

void SourceFiles::include(const Node& written, std::size_t source, Node& merged) {
  const std::filesystem::path path = (description_.folders[source] / *written.text()).lexically_normal();
  const std::filesystem::path identity = identity_of(path);
  const SourceSpan span = description_.span(written.place);
  if (const std::string names = cycle(identity, path.string()); !names.empty()) {
    diagnostics_.error(span, "files include each other in a circle: " + names);
    return;
  }
  if (way_.size() > deepest_include) {
    diagnostics_.error(span, "files are included more than " + std::to_string(deepest_include) + " deep");
    return;
  }
  if (!read_.insert(identity).second) return;
  auto text = read_file(path);
  if (!text.ok()) {
    diagnostics_.error(span, text.error());
    return;
  }
  way_.push_back({path.string(), identity});
  Node part = parse(text.value(), path.string(), path.parent_path());
  way_.pop_back();
  NodeTable kept;
  for (Entry& entry : *part.table()) {
    if (is_merged(entry.name)) {
      kept.push_back(std::move(entry));
    } else if (entry.name != "include") {
      diagnostics_.warning(description_.span(entry.place),
                           "'" + entry.name + "' of an included file is ignored",
                           "only params, frames, materials, lights and objects are taken from it");
    }
  }
  append(merged, Node{std::move(kept), part.place});
}

std::string SourceFiles::cycle(const std::filesystem::path& identity, const std::string& name) const {
  const auto begin =
      std::find_if(way_.begin(), way_.end(), [&](const Step& step) { return step.identity == identity; });
  if (begin == way_.end()) return {};
  std::string names;
  for (auto step = begin; step != way_.end(); ++step) names += step->name + " -> ";
  return names + name;
}

// Adds the tables of `part` to those of `merged`. A parameter replaces one of the same name; duplicates of
// anything else are kept, to be reported.
void SourceFiles::append(Node& merged, Node&& part) {
  for (Entry& entry : *part.table()) {
    Entry* there = find(merged, entry.name);
    if (there == nullptr) {
      merged.table()->push_back(std::move(entry));
    } else if (NodeTable* into = there->node.table(), *from = entry.node.table();
               into != nullptr && from != nullptr) {
      const bool replaces = entry.name == "params";
      std::unordered_map<std::string, std::size_t> place_of;
      for (std::size_t i = 0; replaces && i < into->size(); ++i) place_of.emplace((*into)[i].name, i);
      for (Entry& named : *from) {
        const auto same = replaces ? place_of.find(named.name) : place_of.end();
        if (same != place_of.end()) {
          (*into)[same->second] = std::move(named);
        } else {
          into->push_back(std::move(named));
        }
      }
    } else if (NodeArray* list = there->node.array(), *more = entry.node.array();
               list != nullptr && more != nullptr) {
      std::move(more->begin(), more->end(), std::back_inserter(*list));
    } else {
      merged.table()->push_back(std::move(entry));  // of the wrong type: the check of types reports it
    }
  }
}

}  // namespace backlight
