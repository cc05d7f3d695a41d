// The keys of a material that are formulas of its own time.
#pragma once

#include <optional>
#include <string_view>

#include "backlight/scene/scene.h"
#include "values.h"

namespace backlight {

/// Each of these is nothing when it does not depend on `t`.
std::optional<LobeInTime> read_lobe_in_time(const TableView& material);

/// `given`: the key that says what is reflected, but `spectrum`; `grey` without any.
std::optional<ReflectanceInTime> read_reflectance_in_time(const TableView& material, std::string_view given,
                                                          double grey);

/// `given`: the key that says which light is emitted; `strength`: how much, if that does not depend on `t`.
/// What is neither a blackbody's nor a colour's is a multiple of Material::emission, which has the exposure.
std::optional<EmissionInTime> read_emission_in_time(const TableView& material, std::string_view given,
                                                    double strength, double exposure);

}  // namespace backlight
