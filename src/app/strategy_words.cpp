#include "strategy_words.h"

#include <utility>
#include <vector>

#include "backlight/base/json_text.h"

namespace backlight {
namespace {

constexpr std::size_t most_names = 4;

std::string name_of(const Scene& scene, std::size_t light) {
  const std::string& name = scene.lights[light].name;
  return name.empty() ? "light " + std::to_string(light + 1) : "'" + name + "'";
}

// What is said of lights, and which they are, in the order of the first of each.
struct Alike {
  std::string words;
  std::vector<std::size_t> lights;
};

std::vector<Alike> grouped(const TraceStrategy& strategy) {
  std::vector<Alike> groups;
  for (std::size_t i = 0; i < strategy.shadows.size(); ++i) {
    std::string words = in_words(strategy.shadows[i]);
    Alike* found = nullptr;
    for (Alike& group : groups) {
      if (group.words == words) found = &group;
    }
    if (found == nullptr) found = &groups.emplace_back(Alike{std::move(words), {}});
    found->lights.push_back(i);
  }
  return groups;
}

}  // namespace

std::string strategy_lines(const Scene& scene, const TraceStrategy& strategy) {
  std::string text = "  rays       " + strategy.rays + "; " + in_words(strategy.camera) + '\n';
  const char* label = "  shadows    ";
  for (const Alike& group : grouped(strategy)) {
    text += label;
    label = "             ";
    if (group.lights.size() > most_names) {
      text += std::to_string(group.lights.size()) + " lights";
    } else {
      for (std::size_t i = 0; i < group.lights.size(); ++i)
        text += (i > 0 ? ", " : "") + name_of(scene, group.lights[i]);
    }
    text += ": " + group.words + '\n';
  }
  return text;
}

std::string reuse_line(const CompileCounts& counts) {
  const auto share = [](std::size_t reused, std::size_t made, const char* what) {
    return std::to_string(reused) + " of " + std::to_string(reused + made) + ' ' + what;
  };
  return "  reuse      from image to image " +
         share(counts.surfaces_reused, counts.surfaces_made, "surfaces") + ", " +
         share(counts.materials_reused, counts.materials_made, "materials") + '\n';
}

std::string shadows_json(const TraceStrategy& strategy) {
  std::string json = "[";
  for (const CullingChoice& choice : strategy.shadows) {
    if (json.size() > 1) json += ',';
    json += json_quoted(in_words(choice));
  }
  return json + "]";
}

}  // namespace backlight
