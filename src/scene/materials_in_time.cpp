#include "materials_in_time.h"

#include <array>

#include "own_time.h"

namespace backlight {
namespace {

ReflectanceInTime::Rgb constants(const Vec3& rgb) {
  return {constant_formula(rgb.r), constant_formula(rgb.g), constant_formula(rgb.b)};
}

// A number that is a formula in any case.
Expression number_in_time(const TableView& table, std::string_view key) {
  const auto formula = table.in_own_time(key);
  return formula ? *formula : constant_formula(table.number(key));
}

std::array<ReflectanceInTime::Rgb, 2> squares_in_time(const TableView& checker) {
  std::array<ReflectanceInTime::Rgb, 2> colours;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto formulas = checker.vector_in_own_time("colors", i);
    colours[i] = formulas ? *formulas : constants(checker.vector_at("colors", i));
  }
  return colours;
}

// `given`: the key that says what is reflected.
bool reflectance_changes(const TableView& material, std::string_view given) {
  if (material.in_own_time("uv") || material.in_own_time("ir")) return true;
  if (given == "color") return material.vector_in_own_time("color").has_value();
  if (given != "checker") return false;
  const TableView checker = material.table("checker", "material.checker");
  return checker.vector_in_own_time("colors", 0) || checker.vector_in_own_time("colors", 1);
}

}  // namespace

std::optional<LobeInTime> read_lobe_in_time(const TableView& material) {
  if (!material.in_own_time("specular") && !material.in_own_time("shininess")) return std::nullopt;
  return LobeInTime{number_in_time(material, "specular"), number_in_time(material, "shininess")};
}

std::optional<ReflectanceInTime> read_reflectance_in_time(const TableView& material, std::string_view given,
                                                          double grey) {
  if (!reflectance_changes(material, given)) return std::nullopt;
  ReflectanceInTime reflectance;
  if (given == "color") {
    const auto formulas = material.vector_in_own_time("color");
    reflectance.colours[0] = formulas ? *formulas : constants(material.vector("color"));
  } else if (given == "checker") {
    reflectance.colours = squares_in_time(material.table("checker", "material.checker"));
  } else {
    reflectance.colours[0] = constants(Vec3{grey});
  }
  if (material.has("uv")) reflectance.uv = number_in_time(material, "uv");
  if (material.has("ir")) reflectance.ir = number_in_time(material, "ir");
  return reflectance;
}

std::optional<EmissionInTime> read_emission_in_time(const TableView& material, std::string_view given,
                                                    double strength, double exposure) {
  const auto formula = material.in_own_time("emission");
  const auto temperature = material.in_own_time("temperature");
  const auto colour = material.vector_in_own_time("emission_color");
  const bool light_changes = (given == "temperature" && temperature) || (given == "emission_color" && colour);
  if (!formula && !light_changes) return std::nullopt;
  EmissionInTime emission;
  emission.strength = formula ? *formula : constant_formula(strength);
  if (given == "temperature") {
    emission.temperature = temperature ? *temperature : number_in_time(material, "temperature");
    emission.absolute = material.boolean("absolute");
    emission.exposure = exposure;
  } else if (given == "emission_color") {
    emission.colour = colour ? *colour : constants(material.vector("emission_color"));
    emission.exposure = exposure;
  }
  return emission;
}

}  // namespace backlight
