// Colours and materials of a description.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "backlight/scene/resources.h"
#include "backlight/scene/scene.h"
#include "values.h"

namespace backlight {

/// A path of the description, relative to the folder of the text that names it.
std::filesystem::path resolve_path(const ImageValues& values, const Node& written);

/// The texture that a key names; null, and reported, when it cannot be read.
std::shared_ptr<const Texture> read_texture(const TableView& table, std::string_view key,
                                            ResourceCache& cache);

/// The spectrum that the key `spectrum` gives as a table or a file; nothing when it is wrong (and reported).
/// `greatest`: no value may be larger.
std::optional<Spectrum> read_spectrum_key(const TableView& table, ResourceCache& cache, double greatest);

/// A light of film Y 1 (for a colour: of that colour): D65, a blackbody or a coloured illuminant.
Colour white_light();
Colour blackbody_light(double kelvin);
Colour coloured_light(const LinearRgb& rgb);
/// A light times a strength >= 0.
Colour times(const Colour& light, double strength);

/// The materials of a scene: the named ones, and those written within objects.
class Materials {
 public:
  Materials(ImageValues& values, ResourceCache& cache, std::vector<Material>& scene_materials);

  /// The index of an object's material, a grey of 0.8 by default.
  int of(const TableView& object);

  /// To be called after the last material: gives the reflectances made from RGB their spectra.
  void finish();

 private:
  // A reflectance given as red, green, blue, whose spectrum is made at the end. `square` < 0: not of a
  // checker.
  struct Pending {
    std::size_t material;
    int square;
    std::optional<double> uv, ir;
  };

  int add(const TableView& table, const std::string& name);
  void read_reflectance(const TableView& table, Material& material);
  void read_checker(const TableView& table, Material& material);
  void read_emission(const TableView& table, Material& material);

  ImageValues& values_;
  ResourceCache& cache_;
  std::vector<Material>& materials_;
  std::unordered_map<std::string, int> named_;
  std::vector<Pending> pending_;
  int grey_ = -1;
};

}  // namespace backlight
