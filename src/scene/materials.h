// Colours and materials of a description.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "backlight/scene/resources.h"
#include "backlight/scene/scene.h"
#include "compiled_parts.h"
#include "values.h"

namespace backlight {

/// A path of the description, relative to the folder of the text that names it.
std::filesystem::path resolve_path(const ImageValues& values, const Node& written);

/// The texture that a key names; null, and reported, when it cannot be read.
std::shared_ptr<const Texture> read_texture(const TableView& table, std::string_view key,
                                            ResourceCache& cache);

/// The reflectance that the key `spectrum` gives as a table or a file; nothing when it is wrong (and
/// reported).
std::optional<Spectrum> read_reflectance_spectrum(const TableView& table, ResourceCache& cache);

/// The light of film Y 1 that the key `spectrum` (as it is called in this table) and `lines` give together;
/// nothing when neither is there, or wrong (and reported).
std::optional<Colour> read_light_spectrum(const TableView& table, std::string_view spectrum,
                                          ResourceCache& cache);

/// Reports `lines` beside `given`, which is another key for the colour of a light than `spectrum`; false
/// then.
bool light_lines_stand_alone(const TableView& table, std::string_view given, std::string_view spectrum);

/// A light of film Y 1 (for a colour: of that colour): D65, a blackbody or a coloured illuminant.
Colour white_light();
Colour coloured_light(const LinearRgb& rgb);
/// The blackbody of the key `temperature`; nothing when it is wrong (and reported). Of film Y 1, or, where
/// the table says `absolute = true`, of its luminance in cd/m^2.
std::optional<Colour> read_blackbody(const TableView& table);
/// Reports `absolute = true` where nothing has a temperature, as `given` says: the key that says what the
/// light is, or nothing.
void check_absolute(const TableView& table, std::string_view given);
/// A light times a strength >= 0.
Colour times(const Colour& light, double strength);

/// The materials of a scene: the named ones, and those written within objects.
class Materials {
 public:
  /// Takes over what the images before have found, and leaves in `parts` what those after may.
  /// `exposure`: that of the film, for what shines by itself.
  Materials(ImageValues& values, ResourceCache& cache, CompiledParts& parts, double exposure);

  /// The index of an object's material, a grey of 0.8 by default.
  int of(const TableView& object);
  /// Those of the file of an object's mesh, by the mesh's members.
  std::vector<int> of_model(const TableView& object, const LoadedModel& model);

  /// Whether the material of this index is glass.
  [[nodiscard]] bool is_glass(int material) const { return made(material).glass != nullptr; }
  /// Whether it has a texture or a checker.
  [[nodiscard]] bool has_pattern(int material) const {
    return made(material).texture != nullptr || made(material).checker != nullptr;
  }

  /// To be called after the last material: all of them, with the spectra of those made from RGB.
  SharedVector<Material> finish(CompileCounts& counts);

 private:
  // A reflectance given as red, green, blue, whose spectrum is made at the end: of a material, or of one of
  // the squares of its checker, or of its mirror.
  struct Pending {
    std::size_t material;
    Colour* colour;  // or null: the material's reflectance
    std::optional<double> uv, ir;
  };

  [[nodiscard]] const Material& made(int material) const {
    const auto index = static_cast<std::size_t>(material);
    return reuses_ ? plan_.made[index] : materials_[index];
  }
  int add(const MaterialPlan::Place& place);
  void read(const MaterialPlan::Place& place);
  void read_of_file(const MaterialPlan::Place& place);
  void make_spectra();
  void read_reflectance(const TableView& table, Material& material, MaterialInTime& in_time);
  std::shared_ptr<const Glass> read_glass(const TableView& table);
  std::shared_ptr<Colour> read_shares(const TableView& table, std::string_view key);
  static std::shared_ptr<Checker> read_checker(const TableView& table);
  void read_emission(const TableView& table, Material& material, MaterialInTime& in_time);
  [[nodiscard]] std::optional<Colour> read_emission_light(const TableView& table, std::string_view given);

  double exposure_;
  ImageValues& values_;
  ResourceCache& cache_;
  CompiledParts& parts_;
  MaterialPlan& plan_;
  bool reuses_;  // all materials
  std::vector<Material> materials_;
  std::vector<Pending> pending_;
};

}  // namespace backlight
