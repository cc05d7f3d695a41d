#include "backlight/scene/compile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "compile_parts.h"
#include "time_dependence.h"
#include "words.h"

namespace backlight {
namespace {

// Parameters in the order in which they use each other.
void evaluate_parameters(ImageValues& values) {
  const std::vector<const Entry*> parameters = values.description.parameters();
  for (const std::size_t i : values.description.parameter_order) {
    const Node& node = parameters[i]->node;
    if (const auto* number = std::get_if<double>(&node.value)) values.variables[i] = *number;
    if (const auto* expression = std::get_if<Expression>(&node.value)) {
      values.variables[i] = expression->evaluate(values.variables);
    }
  }
}

void check_parameters(ImageValues& values) {
  const std::vector<const Entry*> parameters = values.description.parameters();
  for (const std::size_t i : values.description.parameter_order) {
    const Entry* entry = parameters[i];
    // What depends on t is no number by itself: it is judged where it stands.
    if (std::isfinite(values.variables[i]) || values.description.follows_t[i]) continue;
    const auto* expression = std::get_if<Expression>(&entry->node.value);
    const bool by_another = expression != nullptr && values.uses_wrong_variable(*expression);
    if (!by_another)
      values.error(entry->node.place,
                   "the parameter '" + entry->name + "' is " + number_text(values.variables[i]) +
                       " at t = " + number_text(values.variables[0]) + ", which is not a finite number");
    values.variables[i] = 0.0;
    values.wrong_variables.insert(i);
  }
}

ImageValues variables_without_time(const Description& description, Diagnostics& diagnostics) {
  ImageValues values{description, std::vector<double>(description.variables.size(), 0.0), diagnostics};
  for (const std::size_t i : {variable_t, variable_frame, variable_image_time})
    values.variables[i] = std::numeric_limits<double>::quiet_NaN();
  evaluate_parameters(values);
  const TimeDependence dependence(description);
  const std::vector<const Entry*> parameters = description.parameters();
  for (const std::size_t i : description.parameter_order) {  // reported at the image's own time
    if (!std::isfinite(values.variables[i]) && !dependence.changes(parameters[i]->node))
      values.wrong_variables.insert(i);
  }
  return values;
}

struct Animation {
  double fps = 25.0;
  int first = 1;
  int last = 1;
  bool written = false;
};

// t depends on it, so that it cannot depend on t: with t = NaN whatever does is NaN.
Animation read_animation(const Description& description, Diagnostics& diagnostics) {
  Animation animation;
  const Entry* entry = find(description.root, "animation");
  if (entry == nullptr) return animation;
  animation.written = true;
  ImageValues values = variables_without_time(description, diagnostics);
  const TableView table = TableView::top(values, "animation");
  animation.fps = table.number("fps");
  const std::vector<double> frames = table.numbers("frames");
  if (frames[0] > frames[1]) {
    table.error("frames", "'frames' is empty: the first frame number, " + number_text(frames[0]) +
                              ", is after the last, " + number_text(frames[1]));
  }
  animation.first = static_cast<int>(frames[0]);
  animation.last = static_cast<int>(frames[1]);
  return animation;
}

void set_time(ImageValues& values, const ImageRequest& request, const Animation& animation) {
  double frame = request.frame.value_or(animation.first);
  double t = animation.written ? (frame - 1.0) / animation.fps : 0.0;
  if (request.time) {
    t = *request.time;
    if (!request.frame) frame = animation.written ? t * animation.fps + 1.0 : 1.0;
  }
  values.variables[variable_t] = values.variables[variable_image_time] = t;
  values.variables[variable_frame] = frame;
  if (!animation.written || request.time || std::abs(t) <= greatest_magnitude) return;
  const TableView table = TableView::top(values, "animation");
  table.error("fps", "frame " + number_text(frame) + " is at t = " + number_text(t) +
                         " s, but times must be at most " + number_text(greatest_magnitude) + " s in size");
}

Effects read_effects(const TableView& table, Effects effects) {
  if (table.has("light_delay")) effects.light_delay = table.boolean("light_delay");
  if (table.has("doppler")) effects.doppler = table.boolean("doppler");
  BrightnessSwitches& on = effects.brightness;
  if (table.has_valid("searchlight")) {
    const std::string mode = table.text("searchlight");
    on.photon_energy = on.solid_angle = mode != "off";
    on.arrival_rate = mode == "exact"   ? ArrivalRate::exact
                      : mode == "paper" ? ArrivalRate::dilation
                                        : ArrivalRate::off;
  }
  if (table.has("energy")) on.photon_energy = table.boolean("energy");
  if (table.has_valid("rate")) {
    const std::string rate = table.text("rate");
    on.arrival_rate = rate == "exact"      ? ArrivalRate::exact
                      : rate == "dilation" ? ArrivalRate::dilation
                                           : ArrivalRate::off;
  }
  if (table.has("solid_angle")) on.solid_angle = table.boolean("solid_angle");
  return effects;
}

void check_aovs(const std::vector<std::string>& names, Diagnostics& diagnostics) {
  const Key& key = *find_key(*find_table("film"), "aovs");
  const std::vector<std::string> known(key.choices.begin(), key.choices.end());
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string hint = did_you_mean(name, known);
    if (hint.empty()) hint = "it is one of " + listed(known);
    diagnostics.error({}, "there is no AOV '" + name + "'", hint);
  }
}

void check_request(const ImageRequest& request, Diagnostics& diagnostics) {
  const KeyTable& film = *find_table("film");
  const auto check = [&](std::string_view name, double value) {
    const Range& range = find_key(film, name)->range;
    if (range.contains(value)) return;
    diagnostics.error({}, "'" + std::string(name) + "' is " + number_text(value) +
                              " on the command line, but must be " + range.words());
  };
  if (request.resolution) {
    check("resolution", request.resolution->first);
    check("resolution", request.resolution->second);
  }
  if (request.samples) check("samples", *request.samples);
  if (request.tolerance) check("tolerance", *request.tolerance);
  if (request.wavelengths) check("wavelengths", *request.wavelengths);
  if (request.aovs) check_aovs(*request.aovs, diagnostics);
  if (request.time && !(std::abs(*request.time) <= greatest_magnitude))
    diagnostics.error({},
                      "the time must be a number, at most " + number_text(greatest_magnitude) + " in size");
}

// What is given by number wins over the tolerance, and the command line over the file.
void read_accuracy(const TableView& table, const ImageRequest& request, FilmSettings& film) {
  const bool asked = request.tolerance.has_value();
  film.tolerance = asked ? *request.tolerance : table.optional_number("tolerance").value_or(0.0);
  film.samples = request.samples.value_or(static_cast<int>(table.number("samples")));
  film.adaptive = film.tolerance > 0.0 && !request.samples && (asked || !table.has("samples"));
  if (film.adaptive) film.samples = most_adaptive_samples;
  const double in_file = asked ? 0.0 : table.optional_number("wavelengths").value_or(0.0);
  film.wavelengths = request.wavelengths.value_or(static_cast<int>(in_file));
}

FilmSettings read_film(ImageValues& values, const ImageRequest& request) {
  const TableView table = TableView::top(values, "film");
  FilmSettings film;
  const std::vector<double> size = table.numbers("resolution");
  film.width = static_cast<int>(size[0]);
  film.height = static_cast<int>(size[1]);
  film.seed = static_cast<unsigned>(table.number("seed"));
  film.exposure = table.number("exposure");
  film.bounces = static_cast<int>(table.number("bounces"));
  if (const Node* aovs = table.node_of("aovs"); aovs != nullptr && aovs->array() != nullptr) {
    for (const Node& name : *aovs->array()) {
      if (name.text() != nullptr) film.aovs.push_back(*name.text());
    }
  }
  check_request(request, values.diagnostics);
  if (request.resolution) std::tie(film.width, film.height) = *request.resolution;
  read_accuracy(table, request, film);
  film.seed = request.seed.value_or(film.seed);
  if (request.aovs) film.aovs = *request.aovs;
  std::vector<std::string> once;
  for (const std::string& name : film.aovs) {
    if (std::find(once.begin(), once.end(), name) == once.end()) once.push_back(name);
  }
  film.aovs = once;
  return film;
}

std::string camera_name(const Description& description, const ImageRequest& request) {
  const Entry* entry = find(description.root, "camera");
  if (!request.camera.empty() || entry == nullptr) return request.camera;
  const NodeArray* cameras = entry->node.array();
  const bool none = cameras != nullptr && cameras->empty();
  const Entry* name = none ? nullptr : find(cameras != nullptr ? cameras->front() : entry->node, "name");
  return name != nullptr && name->node.text() != nullptr ? *name->node.text() : std::string();
}

// Each variable with its derivative by t.
std::vector<Dual> rates_of(const ImageValues& values, double frames_per_second) {
  std::vector<Dual> rates(values.variables.size());
  for (std::size_t i = 0; i < rates.size(); ++i) rates[i].value = values.variables[i];
  rates[variable_t].derivative = rates[variable_image_time].derivative = 1.0;
  rates[variable_frame].derivative = frames_per_second;
  const std::vector<const Entry*> parameters = values.description.parameters();
  for (const std::size_t i : values.description.parameter_order) {
    const auto* expression = std::get_if<Expression>(&parameters[i]->node.value);
    if (expression != nullptr)
      rates[i].derivative = expression->evaluate(std::span<const Dual>(rates)).derivative;
  }
  return rates;
}

std::vector<std::pair<std::string, double>> parameters_of(const ImageValues& values) {
  const std::vector<const Entry*> written = values.description.parameters();
  std::vector<std::pair<std::string, double>> parameters;
  for (const std::size_t i : values.description.parameter_order) {
    if (std::isfinite(values.variables[i])) parameters.emplace_back(written[i]->name, values.variables[i]);
  }
  std::ranges::sort(parameters);
  return parameters;
}

}  // namespace

ImageValues image_values(const Description& description, const ImageRequest& request,
                         Diagnostics& diagnostics) {
  ImageValues values{description, std::vector<double>(description.variables.size(), 0.0), diagnostics};
  const Animation animation = read_animation(description, diagnostics);
  set_time(values, request, animation);
  evaluate_parameters(values);
  check_parameters(values);
  values.rates = rates_of(values, animation.written ? animation.fps : 0.0);
  return values;
}

void compile_effects(Compilation& c) {
  const TableView table = TableView::top(c.values, "effects");
  c.scene.effects = read_effects(table, {});
  const Node* regions = table.node_of("region");
  if (regions == nullptr || regions->array() == nullptr) return;
  for (const Node& node : *regions->array()) {
    const TableView region(c.values, &node, *find_table("effects.region"));
    const Effects effects = read_effects(region, c.scene.effects);
    if (!region.complete()) continue;
    const std::size_t errors = c.values.diagnostics.error_count();
    const std::vector<double> r = region.numbers("rect");
    if (c.values.diagnostics.error_count() == errors && (r[0] >= r[2] || r[1] >= r[3])) {
      region.error("rect", "'rect' is empty", "it is [x0, y0, x1, y1] with x0 < x1 and y0 < y1");
    }
    c.scene.regions.push_back({r[0], r[1], r[2], r[3], effects});
  }
}

void compile_film(Compilation& c) {
  c.scene.film = read_film(c.values, c.request);
}

std::optional<ImageFacts> image_facts(const Description& description, const ImageRequest& request) {
  Diagnostics diagnostics;
  ImageValues values = image_values(description, request, diagnostics);
  FilmSettings film = read_film(values, request);
  if (diagnostics.has_errors()) return std::nullopt;
  return ImageFacts{values.variables[0], values.variables[1], camera_name(description, request),
                    std::move(film)};
}

std::vector<int> animation_frames(const Description& description) {
  Diagnostics ignored;
  const Animation animation = read_animation(description, ignored);
  std::vector<int> frames;
  for (int i = animation.first; i <= animation.last && !ignored.has_errors(); ++i) frames.push_back(i);
  return frames;
}

SceneCompiler::SceneCompiler(const Description& description, ResourceCache& cache, Images images)
    : description_(description), cache_(cache), images_(images) {
  forget();
}

SceneCompiler::~SceneCompiler() = default;

void SceneCompiler::forget() {
  parts_ = std::make_unique<CompiledParts>(description_);
  parts_->kept = images_ == Images::several;
}

std::optional<Scene> SceneCompiler::compile(const ImageRequest& request, Diagnostics& diagnostics) {
  Scene scene;
  ImageValues values = image_values(description_, request, diagnostics);
  scene.time = values.variables[0];
  scene.frame = values.variables[1];
  scene.parameters = parameters_of(values);
  scene.c = TableView(values, &description_.root, *find_table("")).number("c");

  Frames frames(values, scene.c, scene.frames);
  Compilation parts{values, request, cache_, scene, frames, *parts_};
  compile_film(parts);
  compile_camera(parts);
  compile_objects(parts);
  compile_lights(parts);
  compile_sky(parts);
  compile_effects(parts);
  if (!diagnostics.has_errors()) foresee_brightness(parts);
  if (!diagnostics.has_errors()) check_reach(parts);
  if (!diagnostics.has_errors()) check_camera_in_glass(parts);
  if (!diagnostics.has_errors()) warn_of_matter_in_glass(parts);
  if (!diagnostics.has_errors()) warn_of_hidden_lamps(parts);
  if (!diagnostics.has_errors() && images_ == Images::several) return scene;
  forget();
  if (!diagnostics.has_errors()) return scene;
  return std::nullopt;
}

std::optional<Scene> compile(const Description& description, const ImageRequest& request,
                             ResourceCache& cache, Diagnostics& diagnostics) {
  return SceneCompiler(description, cache, SceneCompiler::Images::one).compile(request, diagnostics);
}

}  // namespace backlight
