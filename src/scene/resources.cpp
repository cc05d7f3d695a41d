#include "backlight/scene/resources.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "backlight/base/files.h"

namespace backlight {
namespace {

std::string_view trimmed(std::string_view text) {
  const std::string_view space = " \t\r";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

// Without the quotes that some programs put about every field.
std::string_view unquoted(std::string_view field) {
  const bool quoted = field.size() >= 2 && field.front() == '"' && field.back() == '"';
  return quoted ? trimmed(field.substr(1, field.size() - 2)) : field;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(unquoted(trimmed(line.substr(0, end))));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

// Spreadsheets of countries with a decimal comma write semicolons, others tabs.
char separator_of(std::string_view line) {
  for (const char separator : {';', '\t'}) {
    if (line.find(separator) != std::string_view::npos) return separator;
  }
  return ',';
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

// All of a program, as numbers: equal for programs that do the same with the same constants.
std::vector<std::uint64_t> numbers_of(const Tape& tape) {
  std::vector<std::uint64_t> numbers{tape.constants.size()};
  for (const double constant : tape.constants) numbers.push_back(std::bit_cast<std::uint64_t>(constant));
  for (const Instruction& step : tape.instructions) {
    numbers.push_back((static_cast<std::uint64_t>(step.operation) << 32) | step.out);
    numbers.push_back((static_cast<std::uint64_t>(step.a) << 32) | step.b);
  }
  return numbers;
}

// A table of finite numbers, with what its first line says if that is not numbers.
struct CsvTable {
  std::string header;
  std::vector<std::vector<double>> rows;
  std::vector<std::size_t> lines;  // of the rows
};

Result<CsvTable> read_csv(const std::filesystem::path& path, std::size_t columns) {
  const auto text = read_file(path);
  if (!text.ok()) return text.failure();
  if (const std::string fault = fault_of_encoding(text.value()); !fault.empty())
    return Failure{"cannot read " + path.string() + ": " + fault};
  CsvTable table;
  std::string_view rest = without_byte_order_mark(text.value());
  const char line_end = rest.find('\n') != std::string_view::npos ? '\n' : '\r';
  char separator = '\0';
  for (std::size_t line_number = 1; !rest.empty(); ++line_number) {
    const std::size_t end = rest.find(line_end);
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    const bool first = separator == '\0';
    if (first) separator = separator_of(trimmed(line));
    const std::vector<std::string_view> fields = fields_of(line, separator);
    if (std::ranges::all_of(fields, [](std::string_view field) { return field.empty(); })) continue;
    std::vector<double> row;
    for (const std::string_view field : fields) {
      if (const auto value = to_number(field)) row.push_back(*value);
    }
    if (first && row.empty()) {
      for (const std::string_view field : fields)
        table.header += (table.header.empty() ? "" : ",") + std::string(field);
    } else if (row.size() != columns || fields.size() != columns) {
      const std::string between = separator == ';' ? "semicolons" : separator == '\t' ? "tabs" : "commas";
      return Failure{path.string() + ":" + std::to_string(line_number) + ": expected " +
                     std::to_string(columns) + " finite numbers with " + between + " between them" +
                     (separator != ',' && line.find(',') != std::string_view::npos
                          ? "; a decimal point is written ."
                          : "")};
    } else {
      table.rows.push_back(std::move(row));
      table.lines.push_back(line_number);
    }
  }
  return table;
}

}  // namespace

Result<std::vector<CatalogueStar>> read_stars(const std::filesystem::path& path) {
  const std::string header = "right_ascension,declination,magnitude,b_minus_v";
  const auto table = read_csv(path, 4);
  if (!table.ok()) return table.failure();
  if (table.value().header != header) return Failure{path.string() + ": the first line must be " + header};
  std::vector<CatalogueStar> stars;
  for (std::size_t i = 0; i < table.value().rows.size(); ++i) {
    const std::vector<double>& row = table.value().rows[i];
    if (std::abs(row[1]) > 90.0) {
      return Failure{path.string() + ":" + std::to_string(table.value().lines[i]) +
                     ": the declination must be between -90 and 90 degrees"};
    }
    stars.push_back({row[0], row[1], row[2], row[3]});
  }
  return stars;
}

Result<SpectrumTable> read_spectrum(const std::filesystem::path& path) {
  const auto table = read_csv(path, 2);
  if (!table.ok()) return table.failure();
  SpectrumTable spectrum;
  for (const std::vector<double>& row : table.value().rows) {
    spectrum.wavelengths.push_back(row[0]);
    spectrum.values.push_back(row[1]);
  }
  return spectrum;
}

Result<std::shared_ptr<const Texture>> ResourceCache::texture(const std::filesystem::path& path) {
  if (const auto known = textures_.find(path); known != textures_.end()) return known->second;
  used_.push_back({path, {}});
  auto loaded = load_texture(path);
  if (!loaded.ok()) return loaded.failure();
  return textures_[path] = std::make_shared<const Texture>(std::move(loaded).value());
}

Result<std::shared_ptr<const std::vector<CatalogueStar>>> ResourceCache::stars(
    const std::filesystem::path& path) {
  if (const auto known = stars_.find(path); known != stars_.end()) return known->second;
  used_.push_back({path, {}});
  auto loaded = read_stars(path);
  if (!loaded.ok()) return loaded.failure();
  return stars_[path] = std::make_shared<const std::vector<CatalogueStar>>(std::move(loaded).value());
}

Result<SpectrumTable> ResourceCache::spectrum(const std::filesystem::path& path) {
  if (const auto known = spectra_.find(path); known != spectra_.end()) return known->second;
  used_.push_back({path, {}});
  auto loaded = read_spectrum(path);
  if (loaded.ok()) spectra_[path] = loaded.value();
  return loaded;
}

Result<std::shared_ptr<const LoadedModel>> ResourceCache::model(const std::filesystem::path& path,
                                                                bool smooth) {
  const std::pair key{path, smooth};
  if (const auto known = models_.find(key); known != models_.end()) return known->second;
  used_.push_back({path, {}});
  auto read = read_model(path, smooth);
  if (!read.ok()) return read.failure();
  Model model = std::move(read).value();
  for (const std::filesystem::path& file : model.files) used_.push_back({file, {}});
  if (model.mesh.triangles.empty()) return Failure{"cannot use " + path.string() + ": it has no triangles"};
  if (smooth && model.mesh.normals.empty()) add_smooth_normals(model.mesh, crease_angle);
  auto loaded = std::make_shared<LoadedModel>();
  loaded->mesh = std::make_shared<const Mesh>(std::move(model.mesh));
  for (ModelMaterial& its : model.materials)
    loaded->materials.push_back(std::make_shared<const ModelMaterial>(std::move(its)));
  loaded->missing = std::move(model.missing);
  loaded->left_out = model.left_out;
  return models_[key] = loaded;
}

namespace {

Texture times(const Texture& texture, const LinearRgb& color) {
  std::vector<float> rgb;
  rgb.reserve(3 * static_cast<std::size_t>(texture.width()) * static_cast<std::size_t>(texture.height()));
  for (int j = 0; j < texture.height(); ++j) {
    for (int i = 0; i < texture.width(); ++i) {
      const Vec3 texel = texture.texel(i, j) * color;
      for (int k = 0; k < 3; ++k) rgb.push_back(static_cast<float>(texel[k]));
    }
  }
  return {texture.width(), texture.height(), std::move(rgb)};
}

}  // namespace

Result<std::shared_ptr<const Texture>> ResourceCache::texture_of(const ModelMaterial& material,
                                                                 const LinearRgb& color) {
  const std::tuple key{material.texture, material.embedded_texture, Rgb{color.r, color.g, color.b}};
  if (const auto known = textures_of_models_.find(key); known != textures_of_models_.end())
    return known->second;
  std::shared_ptr<const Texture> plain;
  if (!material.texture.empty()) {
    auto loaded = texture(material.texture.lexically_normal());
    if (!loaded.ok()) return loaded.failure();
    plain = loaded.value();
  } else {
    auto decoded = decode_texture(material.embedded_texture);
    if (!decoded.ok()) return decoded.failure();
    plain = std::make_shared<const Texture>(std::move(decoded).value());
  }
  const bool white = color == LinearRgb{1.0};
  return textures_of_models_[key] = white ? plain : std::make_shared<const Texture>(times(*plain, color));
}

Result<std::vector<std::string>> ResourceCache::digests() {
  std::vector<std::string> digests;
  for (UsedFile& file : used_) {
    if (file.digest.empty()) {
      auto digest = sha256_of_file(file.path);
      if (!digest.ok()) return digest.failure();
      file.digest = std::move(digest).value();
    }
    digests.push_back(file.digest);
  }
  return digests;
}

SigmoidReflectance ResourceCache::sigmoid(const LinearRgb& rgb) {
  const auto [there, added] = sigmoids_.emplace(Rgb{rgb.r, rgb.g, rgb.b}, SigmoidReflectance{});
  if (added) there->second = fit_sigmoid(rgb);
  return there->second;
}

std::optional<FormulaBounds> ResourceCache::bounds(const ImplicitFormula& formula) {
  const auto [there, added] = bounds_.try_emplace(numbers_of(formula.expression().tape()));
  if (added) there->second = prove_bounds(formula);
  return there->second;
}

RootFinder ResourceCache::root_finder(const ImplicitFormula& formula, const FormulaBounds& bounds) {
  std::vector<std::uint64_t> key = numbers_of(formula.expression().tape());
  for (int axis = 0; axis < 3; ++axis) {
    key.push_back(std::bit_cast<std::uint64_t>(bounds.low[axis]));
    key.push_back(std::bit_cast<std::uint64_t>(bounds.high[axis]));
  }
  const auto known = finders_.find(key);
  if (known != finders_.end()) return known->second;
  return finders_[key] = choose_root_finder(formula, bounds.low, bounds.high);
}

}  // namespace backlight
