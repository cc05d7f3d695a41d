#include "materials.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>

#include "materials_in_time.h"

namespace backlight {
namespace {

constexpr double default_grey = 0.8;

// In nm. What is plausible reaches from soft X-rays to millimetre waves, which great speeds may bring into
// view.
constexpr double shortest_plausible = 10.0;
constexpr double longest_plausible = 1e6;
constexpr double shortest_visible = 360.0;
constexpr double longest_visible = 830.0;

// Finding the exact spectrum of a colour takes about a millisecond; scenes of more colours than this take all
// of them from the table, whose colours differ by less than can be seen (docs/colour.md).
constexpr std::size_t most_exact_spectra = 200;

// A table that reaches nowhere near visible light is in another unit, or does not do what it seems to: at
// rest its end value is all there is of it. False if that is an error.
bool are_nanometres(const TableView& table, std::string_view key, const SpectrumTable& points) {
  if (points.wavelengths.empty() || points.values.empty()) return true;  // reported by who makes the spectrum
  const double least = *std::ranges::min_element(points.wavelengths);
  const double greatest = *std::ranges::max_element(points.wavelengths);
  const std::string reach = "from " + number_text(least) + " to " + number_text(greatest);
  if (greatest < shortest_plausible || least > longest_plausible) {
    table.error(key, "its wavelengths go " + reach + ", which cannot be nanometres",
                "visible light is from 360 to 830 nm; multiply metres by 1e9, micrometres by 1000");
    return false;
  }
  if (key != "lines" && (greatest < shortest_visible || least > longest_visible)) {
    const double kept = greatest < shortest_visible ? points.values.back() : points.values.front();
    table.warning(key,
                  "none of its wavelengths, " + reach + " nm, is visible: at rest it is " +
                      number_text(kept) + " throughout",
                  "visible light is from 360 to 830 nm; multiply metres by 1e9, micrometres by 1000");
  }
  return true;
}

// Materials that shine bring the film's exposure with them.
bool exposure_changes(const Description& description, const TimeDependence& dependence) {
  const Entry* film = find(description.root, "film");
  const Entry* exposure =
      film != nullptr && film->node.table() != nullptr ? find(film->node, "exposure") : nullptr;
  return exposure != nullptr && dependence.changes(exposure->node);
}

Colour grey(double value) {
  return {Spectrum::constant(value), LinearRgb{value}};
}

}  // namespace

std::filesystem::path resolve_path(const ImageValues& values, const Node& written) {
  return (values.description.folders[written.place.source] / *written.text()).lexically_normal();
}

std::shared_ptr<const Texture> read_texture(const TableView& table, std::string_view key,
                                            ResourceCache& cache) {
  const Node* written = table.node_of(key);
  if (written == nullptr || written->text() == nullptr) return nullptr;
  auto texture = cache.texture(resolve_path(table.values(), *written));
  if (texture.ok()) return texture.value();
  table.error(key, texture.error());
  return nullptr;
}

namespace {

// The points that a key gives as a table or, if it may, as a file; nothing when they are wrong (and
// reported).
std::optional<SpectrumTable> read_points(const TableView& table, std::string_view key,
                                         std::string_view keys_of_table, ResourceCache& cache) {
  const Node* written = table.node_of(key);
  if (written == nullptr || !written->valid()) return std::nullopt;
  if (written->text() != nullptr) {
    auto read = cache.spectrum(resolve_path(table.values(), *written));
    if (!read.ok()) {
      table.error(key, read.error());
      return std::nullopt;
    }
    return are_nanometres(table, key, read.value()) ? std::optional(std::move(read).value()) : std::nullopt;
  }
  const TableView keys = table.table(key, keys_of_table);
  if (!keys.has_valid("wavelengths") || !keys.has_valid("values")) return std::nullopt;  // reported before
  const std::size_t errors = table.values().diagnostics.error_count();
  SpectrumTable points{keys.numbers("wavelengths"), keys.numbers("values")};
  if (table.values().diagnostics.error_count() > errors) return std::nullopt;
  return are_nanometres(table, key, points) ? std::optional(std::move(points)) : std::nullopt;
}

}  // namespace

std::optional<Spectrum> read_reflectance_spectrum(const TableView& table, ResourceCache& cache) {
  auto points = read_points(table, "spectrum", "spectrum", cache);
  if (!points) return std::nullopt;
  if (std::any_of(points->values.begin(), points->values.end(), [](double v) { return v > 1.0; })) {
    table.error("spectrum", "a reflectance must be at most 1");
    return std::nullopt;
  }
  SpectrumOrError made = Spectrum::tabulated(std::move(points->wavelengths), std::move(points->values));
  if (!made.spectrum) table.error("spectrum", made.error);
  return made.spectrum;
}

std::optional<Colour> read_light_spectrum(const TableView& table, std::string_view spectrum,
                                          ResourceCache& cache) {
  SpectrumTable parts[2];
  const std::string_view keys[2] = {spectrum, "lines"};
  const std::string_view tables[2] = {"spectrum", "lines"};
  std::string_view written;
  for (int i = 0; i < 2; ++i) {
    if (!table.has(keys[i])) continue;
    auto points = read_points(table, keys[i], tables[i], cache);
    if (!points) return std::nullopt;
    // By itself first, for an error at its own place.
    const SpectrumOrError alone = i == 0 ? Spectrum::tabulated(points->wavelengths, points->values)
                                         : Spectrum::tabulated({}, {}, points->wavelengths, points->values);
    if (!alone.spectrum) {
      table.error(keys[i], alone.error);
      return std::nullopt;
    }
    parts[i] = std::move(*points);
    written = keys[i];
  }
  if (written.empty()) return std::nullopt;
  const auto made = Spectrum::tabulated(std::move(parts[0].wavelengths), std::move(parts[0].values),
                                        std::move(parts[1].wavelengths), std::move(parts[1].values));
  const LinearRgb rgb = film_colour(*made.spectrum);
  const double y = luminance(rgb);
  if (!(y > 0.0)) {
    table.error(written, "this spectrum has no visible light, by which its strength is measured");
    return std::nullopt;
  }
  return Colour{made.spectrum->scaled(1.0 / y), rgb / y};
}

bool light_lines_stand_alone(const TableView& table, std::string_view given, std::string_view spectrum) {
  if (!table.has("lines") || given.empty() || given == spectrum) return true;
  table.error(
      "lines", "lines beside '" + std::string(given) + "': how strong they are relative to it is not said",
      "give the continuous part as '" + std::string(spectrum) + "', whose values are in the same units");
  return false;
}

Colour white_light() {
  return {Spectrum::d65(), LinearRgb{1.0}};
}

std::optional<Colour> read_blackbody(const TableView& table) {
  const auto kelvin = table.optional_number("temperature");
  if (!kelvin) return std::nullopt;
  const Spectrum spectrum =
      table.boolean("absolute") ? Spectrum::absolute_blackbody(*kelvin) : Spectrum::blackbody(*kelvin);
  return Colour{spectrum, film_colour(spectrum)};
}

void check_absolute(const TableView& table, std::string_view given) {
  if (!table.boolean("absolute") || given == "temperature") return;
  table.error("absolute", "'absolute' is the scale of a blackbody, and there is no temperature",
              "add temperature, or remove it");
}

Colour coloured_light(const LinearRgb& rgb) {
  return {Spectrum::illuminant(rgb), rgb};
}

Colour times(const Colour& light, double strength) {
  const Spectrum spectrum = light.spectrum.scaled(strength);
  // The colour of a body may be too small or too large for a double until it has its strength.
  return {spectrum, spectrum.is_blackbody() ? film_colour(spectrum) : strength * light.rgb};
}

Materials::Materials(ImageValues& values, ResourceCache& cache, CompiledParts& parts, double exposure)
    : exposure_(exposure),
      values_(values),
      cache_(cache),
      parts_(parts),
      plan_(parts.materials),
      reuses_(plan_.complete && !plan_.changes) {
  plan_.changes = plan_.changes || exposure_changes(values.description, parts.dependence);
  if (plan_.complete) {
    for (const MaterialPlan::Place& place : plan_.places) {
      if (!reuses_) read(place);
    }
    return;
  }
  const Entry* named = find(values.description.root, "material");
  if (named == nullptr || named->node.table() == nullptr) return;
  for (const Entry& entry : *named->node.table()) {
    plan_.named.emplace(entry.name, add({&entry.node, entry.name}));
  }
}

int Materials::of(const TableView& object) {
  const Node* written = object.node_of("material");
  if (written != nullptr && written->table() != nullptr) {
    const auto known = plan_.within_objects.find(written);
    if (known != plan_.within_objects.end()) return known->second;
    const int index = add({written, {}});
    if (parts_.kept) plan_.within_objects.emplace(written, index);
    return index;
  }
  if (written != nullptr && written->text() != nullptr) {
    const auto found = plan_.named.find(*written->text());
    if (found != plan_.named.end()) return found->second;
  }
  if (plan_.grey < 0) plan_.grey = add({});
  return plan_.grey;
}

int Materials::add(const MaterialPlan::Place& place) {
  read(place);
  if (parts_.kept) {
    plan_.places.push_back(place);
    plan_.changes = plan_.changes || (place.written != nullptr && !place.of_file &&
                                      parts_.dependence.changes(*place.written, *find_table("material")));
  }
  return static_cast<int>(materials_.size()) - 1;
}

void Materials::read(const MaterialPlan::Place& place) {
  if (place.of_file) return read_of_file(place);
  const TableView table(values_, place.written, *find_table("material"));
  materials_.emplace_back();
  Material& material = materials_.back();
  material.name = place.name;
  MaterialInTime in_time;
  (void)table.one_of({"mirror", "glass"});  // both are an error
  if (table.has("mirror")) material.mirror = read_shares(table, "mirror");
  if (table.has("glass")) material.glass = read_glass(table);
  read_reflectance(table, material, in_time);
  if (const auto lobe = read_lobe_in_time(table)) {
    in_time.lobe = lobe;
  } else {
    material.specular = table.number("specular");
    material.shininess = table.number("shininess");
  }
  read_emission(table, material, in_time);
  if (in_time.reflectance || in_time.lobe || in_time.emission)
    material.in_time = std::make_shared<const MaterialInTime>(std::move(in_time));
}

void Materials::read_reflectance(const TableView& table, Material& material, MaterialInTime& in_time) {
  const std::string_view given = table.one_of({"color", "texture", "checker", "spectrum"});
  const double unwritten = passes_on(material) ? 0.0 : default_grey;
  material.reflectance = grey(unwritten);
  const auto changing =
      given != "spectrum" ? read_reflectance_in_time(table, given, unwritten) : std::nullopt;
  if (changing) {
    in_time.reflectance = changing;
    if (given == "texture") material.texture = read_texture(table, "texture", cache_);
    if (given == "checker") material.checker = read_checker(table);
    return;
  }
  const auto uv = table.optional_number("uv");
  const auto ir = table.optional_number("ir");
  if (given.empty() || given == "color") {
    if (given == "color") material.reflectance.rgb = table.vector("color");
    pending_.push_back({materials_.size() - 1, nullptr, uv, ir});
  } else if (given == "texture") {
    material.texture = read_texture(table, "texture", cache_);
    material.uv = uv;
    material.ir = ir;
  } else if (given == "checker") {
    const std::shared_ptr<Checker> checker = read_checker(table);
    material.checker = checker;
    if (checker) {
      for (Colour& square : checker->colours) pending_.push_back({materials_.size() - 1, &square, uv, ir});
    }
  } else if (const auto spectrum = read_reflectance_spectrum(table, cache_)) {
    material.reflectance = {*spectrum, colour_under_d65(*spectrum)};
    if (uv || ir)
      table.error(uv ? "uv" : "ir", "'spectrum' already says what is reflected outside the visible");
  }
}

// Of red, green and blue, or the same of all.
std::shared_ptr<Colour> Materials::read_shares(const TableView& table, std::string_view key) {
  const bool three = table.node_of(key)->array() != nullptr;
  auto shares = std::make_shared<Colour>(grey(three ? 0.0 : table.number(key)));
  if (three) shares->rgb = table.vector(key);
  pending_.push_back({materials_.size() - 1, shares.get(), {}, {}});
  return shares;
}

std::shared_ptr<const Glass> Materials::read_glass(const TableView& table) {
  const TableView keys = table.table("glass", "material.glass");
  auto glass = std::make_shared<Glass>();
  glass->index = std::max(1.0, keys.number("index"));
  glass->tint = grey(1.0);
  if (keys.has("tint")) {
    const bool three = keys.node_of("tint")->array() != nullptr;
    glass->tint = grey(three ? 0.0 : keys.number("tint"));
    if (three) glass->tint.rgb = keys.vector("tint");
    pending_.push_back({materials_.size() - 1, &glass->tint, {}, {}});
  }
  glass->tinted = glass->tint.rgb != LinearRgb{1.0};
  return glass;
}

std::shared_ptr<Checker> Materials::read_checker(const TableView& table) {
  const TableView keys = table.table("checker", "material.checker");
  const double size = keys.number("size");
  const Node* colours = keys.node_of("colors");
  if (colours == nullptr || colours->array() == nullptr) return nullptr;
  auto checker = std::make_shared<Checker>();
  checker->size = size;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!keys.vector_in_own_time("colors", i)) checker->colours[i].rgb = keys.vector_at("colors", i);
  }
  return checker;
}

void Materials::read_emission(const TableView& table, Material& material, MaterialInTime& in_time) {
  const bool absolute = table.boolean("absolute");
  const auto strength = table.in_own_time("emission");
  const double emission = strength || (absolute && !table.has("emission")) ? 1.0 : table.number("emission");
  std::string_view given = table.one_of({"temperature", "emission_color", "emission_spectrum"});
  check_absolute(table, given);
  const bool wanted = light_lines_stand_alone(table, given, "emission_spectrum");
  if (given.empty() && table.has("lines")) given = "lines";
  if (!given.empty() && !absolute && !table.has("emission")) {
    table.error(given, "'" + std::string(given) + "' is that of the emission, and there is none",
                "add emission = 1, or remove it");
  }
  if (!(emission > 0.0) || !wanted) return;
  auto changing = read_emission_in_time(table, given, emission, exposure_);
  if (changing && (changing->temperature || changing->colour)) {
    in_time.emission = std::move(changing);
    return;
  }
  const auto light = read_emission_light(table, given);
  if (!light) return;
  material.emission = std::make_shared<const Colour>(times(times(*light, emission), exposure_));
  if (changing) in_time.emission = std::move(changing);
}

std::optional<Colour> Materials::read_emission_light(const TableView& table, std::string_view given) {
  if (given == "temperature") return read_blackbody(table).value_or(white_light());
  if (given == "emission_color") return coloured_light(table.vector("emission_color"));
  if (!given.empty()) return read_light_spectrum(table, "emission_spectrum", cache_);
  return white_light();
}

SharedVector<Material> Materials::finish(CompileCounts& counts) {
  if (reuses_) {
    counts.materials_reused = plan_.made.size();
    return plan_.made;
  }
  counts.materials_made = materials_.size();
  make_spectra();
  SharedVector<Material> made(std::move(materials_));
  plan_.complete = parts_.kept;
  if (parts_.kept && !plan_.changes) plan_.made = made;
  return made;
}

void Materials::make_spectra() {
  const auto colour_of = [&](const Pending& p) -> Colour& {
    return p.colour == nullptr ? materials_[p.material].reflectance : *p.colour;
  };
  std::set<std::array<double, 3>> colours;
  for (const Pending& p : pending_) {
    const LinearRgb& rgb = colour_of(p).rgb;
    if (colours.size() <= most_exact_spectra) colours.insert({rgb.r, rgb.g, rgb.b});
  }
  const bool exact = colours.size() <= most_exact_spectra;
  for (const Pending& p : pending_) {
    Colour& colour = colour_of(p);
    const LinearRgb& rgb = colour.rgb;
    const bool is_grey = rgb.r == rgb.g && rgb.g == rgb.b;
    const SigmoidReflectance shape = is_grey ? grey_sigmoid(rgb.r)
                                     : exact ? cache_.sigmoid(rgb)
                                             : upsample(rgb);
    const bool constant = is_grey && !p.uv && !p.ir;
    colour.spectrum = constant ? Spectrum::constant(rgb.r) : Spectrum::sigmoid_reflectance(shape, p.uv, p.ir);
  }
}

}  // namespace backlight
