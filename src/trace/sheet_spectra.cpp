// Shifted colours of the points of a sheet: Tracer::colour and shade_shifted for many.
#include <algorithm>

#include "shading_steps.h"
#include "sheet_shading.h"

namespace backlight {
namespace {

// What the wavelengths make of a material and the lamps. As long as the points have the same shifts, as all
// those have of a surface that rests relative to the camera and a lamp, their colours are those of the point
// before.
class ShiftedColours {
 public:
  ShiftedColours(const ShadingContext& context, int material, SheetScratch& work, Scratch& scratch)
      : context_(context),
        index_(material),
        material_(context.scene->materials[static_cast<std::size_t>(material)]),
        lamps_(work.lamp_light),
        s_(scratch) {}

  // `t`: the matter's own time, in scene seconds.
  void begin(DopplerFactor<Camera, Rest> doppler, double u, double v, double t) {
    const int slot = material_.checker ? checker_slot(*material_.checker, u, v) : 0;
    const bool by_point = material_.texture || material_.in_time;
    if (began_ && doppler.value == doppler_.value && slot == slot_ && !by_point) return;
    began_ = true;
    doppler_ = doppler;
    shift_by(doppler, s_);
    slot_ = slot;
    u_ = u;
    v_ = v;
    t_ = t;
    ready_ = false;
    for (SheetScratch::Lamp& lamp : lamps_) lamp.known = false;
    emitted_ = emitted_colour(context_, index_, t, s_);
  }

  [[nodiscard]] const LinearRgb& emitted() const { return emitted_; }

  const LampColours& under(std::size_t light, DopplerFactor<Rest, Source> doppler) {
    SheetScratch::Lamp& lamp = lamps_[light];
    if (lamp.known && lamp.known_doppler == doppler.value) return lamp.colours;
    if (!ready_) {
      reflectance_ = fill_reflectance(context_, index_, u_, v_, t_, s_);
      ready_ = true;
    }
    lamp.colours =
        lamp_colours(context_.spectra->light(light), doppler, has_lobe(material_), reflectance_, s_);
    lamp.known = true;
    lamp.known_doppler = doppler.value;
    return lamp.colours;
  }

 private:
  const ShadingContext& context_;
  int index_;
  const Material& material_;
  std::vector<SheetScratch::Lamp>& lamps_;
  Scratch& s_;
  bool began_ = false;
  DopplerFactor<Camera, Rest> doppler_;
  int slot_ = 0;
  double u_ = 0.0;
  double v_ = 0.0;
  double t_ = 0.0;
  LinearRgb emitted_{0.0};
  bool ready_ = false;  // wavelengths and reflectance are those of the point
  Reflectance reflectance_;
};

}  // namespace

void SheetShader::light_spectra(const Material& material, int material_index, const Effects& effects) {
  PointSheet& p = work_.points;
  const std::vector<Light>& lights = tracer_.scene().lights;
  // First what of each lamp reaches the points, then, point by point, its colours.
  work_.lamp_light.resize(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    LaneReflection reflection;
    SheetScratch::Lamp& lamp = work_.lamp_light[i];
    lamp.arrives = light_arrives(i, effects, material, reflection);
    if (!lamp.arrives) continue;
    std::copy_n(p.lit, p.count, lamp.lit);
    std::copy_n(p.irradiance, p.count, lamp.irradiance);
    std::copy_n(p.specular, p.count, lamp.specular);
    std::copy_n(p.lamp_doppler, p.count, lamp.doppler);
  }
  const double gamma = tracer_.hub().frames[frame()].from_camera.gamma();
  const ShadingContext context = tracer_.shading();
  ShiftedColours colours(context, material_index, work_, scratch_);
  for (int lane = 0; lane < p.count; ++lane) {
    const DopplerFactor<Camera, Rest> doppler{p.doppler[lane]};
    colours.begin(doppler, p.points.u[lane], p.points.v[lane], own_time(lane));
    LinearRgb sum = colours.emitted();
    for (std::size_t i = 0; i < lights.size(); ++i) {
      SheetScratch::Lamp& lamp = work_.lamp_light[i];
      if (!lamp.arrives || !(lamp.lit[lane] > 0.0)) continue;
      const DopplerFactor<Rest, Source> lamp_doppler{lamp.doppler[lane]};
      sum += reflected_colour(colours.under(i, lamp_doppler), lamp_doppler, lamp.irradiance[lane],
                              lamp.specular[lane]);
    }
    const double factor =
        radiance_factor(doppler, gamma, effects.towards_camera()) * wavelength_density_factor(doppler);
    for (int k = 0; k < 3; ++k) p.rgb[k][lane] = factor * sum[k];
  }
}

}  // namespace backlight
