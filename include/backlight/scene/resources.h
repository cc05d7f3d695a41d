// What a scene takes from other files (textures, spectra, star catalogues), and what takes long to find.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/colour/upsampling.h"
#include "backlight/film/texture.h"
#include "backlight/model/model_file.h"
#include "backlight/surface/implicit_surface.h"

namespace backlight {

/// A catalogue's star: angles in degrees.
struct CatalogueStar {
  double right_ascension = 0.0;
  double declination = 0.0;
  double magnitude = 0.0;
  double b_minus_v = 0.0;
};

/// Values by wavelength in nm, as in a file.
struct SpectrumTable {
  std::vector<double> wavelengths;
  std::vector<double> values;
};

/// Reads a star catalogue: CSV with the header `right_ascension,declination,magnitude,b_minus_v`. Empty lines
/// and those that begin with # are skipped. An error names the line.
Result<std::vector<CatalogueStar>> read_stars(const std::filesystem::path& path);

/// Reads a spectrum: CSV of wavelength in nm and value, with or without a header line.
Result<SpectrumTable> read_spectrum(const std::filesystem::path& path);

/// A model's file, ready to be traced.
struct LoadedModel {
  std::shared_ptr<const Mesh> mesh;
  std::vector<std::shared_ptr<const ModelMaterial>> materials;  ///< by the mesh's members
  std::filesystem::path missing;                                ///< as of Model
  std::size_t left_out = 0;
};

/// Faces that meet at more than this (radians) have an edge, and no common normals, in a model that has none.
inline constexpr double crease_angle = 40.0 * std::numbers::pi / 180.0;

/// Keeps what was read, so that the images of an animation share it. Not for several threads at once.
class ResourceCache {
 public:
  Result<std::shared_ptr<const Texture>> texture(const std::filesystem::path& path);
  Result<std::shared_ptr<const std::vector<CatalogueStar>>> stars(const std::filesystem::path& path);
  Result<SpectrumTable> spectrum(const std::filesystem::path& path);
  /// `smooth`: with the normals of the file or, where it has none, those of its faces averaged.
  Result<std::shared_ptr<const LoadedModel>> model(const std::filesystem::path& path, bool smooth);
  /// The texture of a material of a model, times a linear colour.
  Result<std::shared_ptr<const Texture>> texture_of(const ModelMaterial& material, const LinearRgb& color);
  /// fit_sigmoid(rgb), which takes a while, once for each colour.
  SigmoidReflectance sigmoid(const LinearRgb& rgb);
  /// prove_bounds(formula), which takes up to half a second, once for each formula: the same operations on
  /// the same numbers.
  std::optional<FormulaBounds> bounds(const ImplicitFormula& formula);

  /// choose_root_finder(formula, bounds), once for each formula within the same bounds.
  RootFinder root_finder(const ImplicitFormula& formula, const FormulaBounds& bounds);

  /// SHA-256 (hexadecimal) of the contents of every file that was asked for, in the order of first asking:
  /// what an image depends on besides the scene's own text. Fails if one cannot be read any more.
  Result<std::vector<std::string>> digests();

 private:
  struct UsedFile {
    std::filesystem::path path;
    std::string digest;  // empty until it is asked for
  };
  using Rgb = std::array<double, 3>;
  std::map<std::filesystem::path, std::shared_ptr<const Texture>> textures_;
  std::map<std::filesystem::path, std::shared_ptr<const std::vector<CatalogueStar>>> stars_;
  std::map<std::filesystem::path, SpectrumTable> spectra_;
  std::map<std::pair<std::filesystem::path, bool>, std::shared_ptr<const LoadedModel>> models_;
  std::map<std::tuple<std::filesystem::path, std::string, Rgb>, std::shared_ptr<const Texture>>
      textures_of_models_;
  std::map<Rgb, SigmoidReflectance> sigmoids_;
  std::map<std::vector<std::uint64_t>, std::optional<FormulaBounds>> bounds_;  // by the formula's tape
  std::map<std::vector<std::uint64_t>, RootFinder> finders_;  // by the formula's tape, then the bounds
  std::vector<UsedFile> used_;
};

}  // namespace backlight
