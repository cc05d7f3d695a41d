// Shifted colours of the points of a sheet: lamp_colours and emitted_colour for many.
#include <algorithm>

#include "shading_steps.h"
#include "sheet_shading.h"

namespace backlight {
namespace {

void put(const LinearRgb& colour, double (*to)[sheet_size], std::uint64_t points) {
  for (; points != 0; points &= points - 1) {
    for (int k = 0; k < 3; ++k) to[k][__builtin_ctzll(points)] = colour[k];
  }
}

}  // namespace

// What the surfaces emit themselves, into rgb.
void SheetShader::fill_emission(int index) {
  PointSheet& p = work_.points;
  LinearRgb colour{0.0};
  for (int i = 0; i < p.padded; ++i) {
    if (i == 0 || p.doppler[i] != p.doppler[i - 1]) {
      shift_by({p.doppler[i]}, scratch_);
      colour = emitted_colour(tracer_.shading(), index, 0.0, scratch_);
    }
    put(colour, p.rgb, std::uint64_t{1} << i);
  }
}

// Of one point.
LampColours SheetShader::colours_at(int lane, std::size_t light, int index) {
  const PointSheet& p = work_.points;
  const ShadingContext context = tracer_.shading();
  const Material& material = context.scene->materials[static_cast<std::size_t>(index)];
  SeenSpectrum seen;
  if (!material.texture) {
    seen = context.spectra->reflectance(index, static_cast<int>(p.odd_squares >> lane & 1U));
  } else {
    const auto at = static_cast<std::size_t>(lane);
    work_.texels.resize(sheet_size);
    work_.seen_texels.resize(sheet_size);
    if ((work_.known_texels >> at & 1U) == 0) {
      work_.seen_texels[at] =
          seen_reflectance(context, index, p.points.u[lane], p.points.v[lane], 0.0, work_.texels[at]);
      work_.known_texels |= std::uint64_t{1} << at;
    }
    seen = work_.seen_texels[at];
  }
  shift_by({p.doppler[lane]}, scratch_);
  return lamp_colours(context.spectra->light(light), {p.lamp_doppler[lane]}, material.specular > 0.0,
                      fill_reflectance(seen, scratch_), scratch_);
}

// Of those points where light and reflectance are looked up, which it returns, into `lamp` and `diffuse`.
std::uint64_t SheetShader::look_up(std::size_t light, int index, std::uint64_t points, bool has_lobe) {
  PointSheet& p = work_.points;
  const SceneSpectra& spectra = *tracer_.shading().spectra;
  const SeenSpectrum lamp = spectra.light(light);
  const SpectralKernels& kernels = *scratch_.kernels;
  ReflectedLight& reflected = scratch_.reflected;
  for (int i = 0; i < p.padded; ++i) p.shift[i] = p.lamp_doppler[i] * p.doppler[i];
  double* const film[4] = {p.lamp[0], p.lamp[1], p.lamp[2], p.lamp[3]};
  const std::uint64_t known = LightRows::films(*lamp.spectrum, p.shift, points, film, kernels);
  if (known == 0) return 0;
  SeenSpectrum seen[2];
  bool is_grey[2] = {false, false};
  std::uint64_t done = 0;
  for (const int slot : {0, 1}) {
    const std::uint64_t its = known & (slot == 0 ? ~p.odd_squares : p.odd_squares);
    if (its == 0) continue;
    seen[slot] = spectra.reflectance(index, slot);
    is_grey[slot] = seen[slot].spectrum->is_grey();
    if (!is_grey[slot] && seen[slot].spectrum->has_features()) continue;
    done |= its;
    if (is_grey[slot]) continue;
    const ReflectedLight::Pair pair{std::uint64_t{seen[slot].number} << 32 | lamp.number, lamp.spectrum,
                                    seen[slot].spectrum, seen[slot].set};
    reflected.per_luminance(pair, p.doppler, p.lamp_doppler, lamp.one_lamp_doppler, p.lamp[3], its,
                            {p.diffuse[0], p.diffuse[1], p.diffuse[2]}, kernels);
  }
  if (lamp.spectrum->shape() && (has_lobe || is_grey[0] || is_grey[1])) {
    alignas(64) double ones[sheet_size];
    std::ranges::fill(ones, 1.0);
    reflected.per_luminance({lamp.number, lamp.spectrum, nullptr, lamp.set}, ones, p.shift, false, p.lamp[3],
                            known, {p.lamp[0], p.lamp[1], p.lamp[2]}, kernels);
  }
  for (const int slot : {0, 1}) {
    if (!is_grey[slot]) continue;
    const double grey = seen[slot].spectrum->at(visible_begin_nm);
    std::uint64_t its = known & (slot == 0 ? ~p.odd_squares : p.odd_squares);
    for (; its != 0; its &= its - 1) {
      const int i = __builtin_ctzll(its);
      for (int k = 0; k < 3; ++k) p.diffuse[k][i] = grey * p.lamp[k][i];
    }
  }
  return done;
}

// What the camera's wavelengths make of the material and a lamp of unit strength, where it is lit.
void SheetShader::fill_shifted(std::size_t light, int index, LaneReflection& reflection) {
  PointSheet& p = work_.points;
  const Material& material = tracer_.scene().materials[static_cast<std::size_t>(index)];
  const bool has_lobe = material.specular > 0.0;
  const std::uint64_t lit = lit_points(), odd = lit & p.odd_squares;
  const auto same = [&](const double* numbers) {
    return sheets_.kernels().same(numbers, p.count, numbers[0]) == first_bits(p.count);
  };
  reflection.shifted = true;
  reflection.same_lamp = !has_lobe;
  std::uint64_t left = lit;
  if (!material.texture && same(p.doppler) && same(p.lamp_doppler)) {
    // As all points of a surface that rests relative to the camera and the lamp.
    reflection.same_lamp = true;
    reflection.same_diffuse = odd == 0 || odd == lit;
    for (const std::uint64_t its : {lit & ~odd, odd}) {
      if (its == 0) continue;
      const LampColours colours = colours_at(__builtin_ctzll(its), light, index);
      for (int k = 0; k < 3; ++k) {
        reflection.lamp[k] = colours.whole[k];
        reflection.diffuse[k] = colours.reflected[k];
      }
      if (!reflection.same_diffuse) put(colours.reflected, p.diffuse, its);
    }
    return;
  }
  if (!material.texture) left &= ~look_up(light, index, lit, has_lobe);
  for (; left != 0; left &= left - 1) {
    const int i = __builtin_ctzll(left);
    const LampColours colours = colours_at(i, light, index);
    put(colours.reflected, p.diffuse, std::uint64_t{1} << i);
    put(colours.whole, p.lamp, std::uint64_t{1} << i);
  }
}

}  // namespace backlight
