// Lights, materials and the sky: their colours, spectra and strengths.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "backlight/base/files.h"
#include "backlight/colour/stars.h"
#include "backlight/scene/compile.h"
#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;

Material material_of(const std::string& keys) {
  return compiled(camera + "[[object]]\nshape = \"plane\"\nmaterial = { " + keys + " }\n").materials.front();
}

Light light_of(const std::string& keys) {
  return compiled("c = 2\n" + camera + "[[light]]\n" + keys).lights.at(0);
}

void expect_near(const LinearRgb& a, const LinearRgb& b, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

TEST(SceneMaterials, AGreyByDefault) {
  const Scene scene = compiled(camera + "[[object]]\nshape = \"plane\"\n[[object]]\nshape = \"plane\"\n");
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].reflectance.rgb, LinearRgb{0.8});
  EXPECT_EQ(scene.materials[0].reflectance.spectrum.at(100), 0.8);
  EXPECT_EQ(scene.materials[0].emission, nullptr);
}

TEST(SceneMaterials, NamedAndInline) {
  const Scene scene = compiled(camera +
                               "[material.a]\ncolor = [0.1, 0.2, 0.3]\nspecular = 0.25\nshininess = 7\n"
                               "[[object]]\nshape = \"plane\"\nmaterial = \"a\"\n"
                               "[[object]]\nshape = \"plane\"\nmaterial = { color = [0.3, 0.2, 0.1] }\n"
                               "[[object]]\nshape = \"plane\"\nmaterial = \"a\"\n");
  const auto material = [&](std::size_t object) {
    return scene.materials[static_cast<std::size_t>(scene.objects[object].material)];
  };
  EXPECT_EQ(material(0).reflectance.rgb, (LinearRgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(material(0).specular, 0.25);
  EXPECT_EQ(material(0).shininess, 7.0);
  EXPECT_EQ(material(1).reflectance.rgb, (LinearRgb{0.3, 0.2, 0.1}));
  EXPECT_EQ(scene.objects[0].material, scene.objects[2].material);
}

TEST(SceneMaterials, ColoursHaveTheirSpectra) {
  const Material material = material_of("color = [0.6, 0.25, 0.2]");
  expect_near(colour_under_d65(material.reflectance.spectrum), {0.6, 0.25, 0.2}, 1e-8);
}

TEST(SceneMaterials, LevelsBeyondTheVisible) {
  const Material material = material_of("color = [0.6, 0.25, 0.2], uv = 0.125, ir = 0.875");
  EXPECT_EQ(material.reflectance.spectrum.at(100), 0.125);
  EXPECT_EQ(material.reflectance.spectrum.at(2000), 0.875);
}

TEST(SceneMaterials, Checker) {
  const Material material = material_of("checker = { colors = [[1, 1, 1], [0.1, 0.2, 0.3]], size = 0.5 }");
  ASSERT_NE(material.checker, nullptr);
  EXPECT_EQ(material.checker->size, 0.5);
  EXPECT_EQ(material.checker->colours[0].rgb, LinearRgb{1.0});
  expect_near(colour_under_d65(material.checker->colours[1].spectrum), {0.1, 0.2, 0.3}, 1e-8);
}

TEST(SceneMaterials, SpectrumOutright) {
  const Material material = material_of("spectrum = { wavelengths = [400, 500], values = [0.2, 0.4] }");
  EXPECT_NEAR(material.reflectance.spectrum.at(450), 0.3, 1e-15);
  EXPECT_EQ(material.reflectance.spectrum.at(900), 0.4);
  expect_near(material.reflectance.rgb, colour_under_d65(material.reflectance.spectrum), 0.0);
}

TEST(SceneMaterials, Emission) {
  const Material white = material_of("emission = 3");
  ASSERT_NE(white.emission, nullptr);
  EXPECT_EQ(white.emission->rgb, LinearRgb{3.0});
  const Material hot = material_of("emission = 2, temperature = 3000");
  EXPECT_NEAR(luminance(hot.emission->rgb), 2.0, 1e-9);
  EXPECT_GT(hot.emission->rgb.r, hot.emission->rgb.b);
  expect_near(film_colour(hot.emission->spectrum), hot.emission->rgb, 1e-12);
  const Material red = material_of("emission = 2, emission_color = [1, 0.5, 0.25]");
  EXPECT_EQ(red.emission->rgb, (LinearRgb{2, 1, 0.5}));
  expect_near(film_colour(red.emission->spectrum), red.emission->rgb, 1e-6);
}

// More colours than are worth an exact spectrum each take them from the table.
TEST(SceneMaterials, ManyColours) {
  std::string text = camera;
  for (int i = 0; i < 300; ++i) {
    text += "[[object]]\nshape = \"sphere\"\nradius = 1\nmaterial = { color = [" + std::to_string(i / 300.0) +
            ", 0.5, 0.25] }\n";
  }
  const Scene scene = compiled(text);
  for (const Material& material : scene.materials) {
    expect_near(colour_under_d65(material.reflectance.spectrum), material.reflectance.rgb, 0.01);
  }
}

TEST(SceneLights, APointOfStrengthOneByDefault) {
  const Light light = light_of("position = [1, 2, 3]\n");
  EXPECT_EQ(light.kind, LightKind::point);
  EXPECT_EQ(light.position, (Vec3{1, 2, 3}));
  EXPECT_EQ(light.strength, 1.0);
  EXPECT_FALSE(light.flickers);
  EXPECT_TRUE(light.colour.spectrum.is_d65_shaped());
  EXPECT_EQ(light.colour.rgb, LinearRgb{1.0});
}

TEST(SceneLights, Types) {
  const Light sun = light_of("type = \"distant\"\ndirection = [0, -3, 4]\nirradiance = 5\n");
  EXPECT_EQ(sun.kind, LightKind::distant);
  EXPECT_EQ(sun.direction, (Vec3{0, -0.6, 0.8}));
  EXPECT_EQ(sun.strength, 5.0);
  const Light ambient = light_of("type = \"ambient\"\nradiance = 0.25\n");
  EXPECT_EQ(ambient.kind, LightKind::ambient);
  EXPECT_EQ(ambient.strength, 0.25);
}

TEST(SceneLights, ColoursAreOfUnitStrength) {
  // But for a blackbody, which takes its strength into the logarithm of its spectrum.
  const Light hot = light_of("temperature = 2700\nintensity = 300\n");
  EXPECT_NEAR(luminance(hot.colour.rgb), 300.0, 1e-7);
  EXPECT_EQ(hot.strength, 1.0);
  const Light flicker = light_of("temperature = 2700\nintensity = \"300*t\"\n");
  EXPECT_NEAR(luminance(flicker.colour.rgb), 1.0, 1e-9);
  const Light red = light_of("color = [1, 0.25, 0.125]\n");
  EXPECT_EQ(red.colour.rgb, (LinearRgb{1, 0.25, 0.125}));
  expect_near(film_colour(red.colour.spectrum), red.colour.rgb, 1e-6);
  const Light line = light_of("spectrum = { wavelengths = [580, 590, 600], values = [0, 7, 0] }\n");
  EXPECT_NEAR(luminance(line.colour.rgb), 1.0, 1e-12);
  EXPECT_NEAR(luminance(film_colour(line.colour.spectrum)), 1.0, 1e-12);
}

// The observer's value at 589 and at 121.6 nm: only the first is seen at rest, and measures the strength.
TEST(SceneLights, LinesAreOfUnitStrengthTogether) {
  const Light lamp = light_of("intensity = 7\nlines = { wavelengths = [589.0, 121.6], values = [2, 5] }\n");
  EXPECT_EQ(lamp.strength, 7.0);
  EXPECT_NEAR(luminance(lamp.colour.rgb), 1.0, 1e-12);
  const Spectrum& spectrum = lamp.colour.spectrum;
  ASSERT_EQ(spectrum.lines().size(), 2U);
  EXPECT_EQ(spectrum.lines()[1].nm, 121.6);
  EXPECT_EQ(spectrum.lines()[1].power / spectrum.lines()[0].power, 2.5);
  EXPECT_EQ(spectrum.at(589.0), 0.0);
  // Beside a spectrum: a line of value 30 is as much as 30 nm of value 1.
  const Light both = light_of(
      "spectrum = { wavelengths = [400, 700], values = [1, 1] }\n"
      "lines = { wavelengths = [589], values = [30] }\n");
  EXPECT_NEAR(luminance(both.colour.rgb), 1.0, 1e-12);
  const double scale = both.colour.spectrum.scale();
  EXPECT_NEAR(both.colour.spectrum.at(500.0), scale, 1e-15);
  EXPECT_EQ(both.colour.spectrum.lines()[0].power, 30.0);
}

TEST(SceneMaterials, EmissionHasASpectrumAndLines) {
  const Material gas = material_of("emission = 3, lines = { wavelengths = [486.1, 656.3], values = [1, 4] }");
  ASSERT_NE(gas.emission, nullptr);
  EXPECT_NEAR(luminance(gas.emission->rgb), 3.0, 1e-12);
  EXPECT_EQ(gas.emission->spectrum.lines().size(), 2U);
  const Material led = material_of(
      "emission = 2, emission_spectrum = { wavelengths = [500, 500.2, 500.4], values = [0, 9, 0] }");
  ASSERT_NE(led.emission, nullptr);
  EXPECT_NEAR(luminance(led.emission->rgb), 2.0, 1e-12);
  EXPECT_NEAR(luminance(film_colour(led.emission->spectrum)), 2.0, 1e-12);
}

TEST(SceneLights, FlickerInTheirOwnTime) {
  const std::string text = "[params]\nrate = 3\n[animation]\nfps = 1\nframes = [5, 5]\n" + camera +
                           "[[light]]\nintensity = \"rate * t + frame\"\nvelocity = [0.5, 0, 0]\n"
                           "[[light]]\nintensity = \"rate * frame\"\n";
  const Scene scene = compiled(text);
  const Light& light = scene.lights[0];
  ASSERT_TRUE(light.flickers);
  EXPECT_EQ(light.strength_of_time.evaluate(std::array{10.0}), 35.0);
  EXPECT_FALSE(scene.lights[1].flickers);
  EXPECT_EQ(scene.lights[1].strength, 15.0);
}

TEST(SceneSky, BlackWithoutABackground) {
  const Sky sky = compiled(camera).sky;
  EXPECT_FALSE(sky.emits);
  EXPECT_EQ(sky.frame, 0);
  EXPECT_TRUE(sky.stars.empty());
}

TEST(SceneSky, ColourAndTemperature) {
  const Sky blue = compiled(camera + "[background]\ncolor = [0.5, 0.7, 1]\nradiance = 2\n").sky;
  EXPECT_TRUE(blue.emits);
  EXPECT_EQ(blue.radiance.rgb, (LinearRgb{1, 1.4, 2}));
  expect_near(film_colour(blue.radiance.spectrum), blue.radiance.rgb, 1e-6);
  const Sky hot =
      compiled(camera + "[background]\ntemperature = 4000\nradiance = 3\nbeta = [0, 0, 0.5]\n").sky;
  EXPECT_NEAR(luminance(hot.radiance.rgb), 3.0, 1e-8);
  EXPECT_EQ(hot.frame, 1);
}

TEST(SceneSky, StarsOfACatalogue) {
  const std::string folder = std::string(BACKLIGHT_BINARY_DIR);
  ASSERT_TRUE(write_file(folder + "/three_stars.csv",
                         "right_ascension,declination,magnitude,b_minus_v\n"
                         "# towards +z, +x and +y\n0,0,0,0.65\n90, 0, 5, 0\r\n\n10,90,-2.5,1.5\n")
                  .ok());
  const Scene scene = compiled(
      camera + "[background]\nstars = { file = \"three_stars.csv\", brightness = 2 }\n", {}, {}, folder);
  ASSERT_EQ(scene.sky.stars.size(), 3U);
  EXPECT_NEAR(glm::distance(scene.sky.stars[0].direction, Vec3{0, 0, 1}), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(scene.sky.stars[1].direction, Vec3{1, 0, 0}), 0.0, 1e-15);
  EXPECT_NEAR(glm::distance(scene.sky.stars[2].direction, Vec3{0, 1, 0}), 0.0, 1e-15);
  EXPECT_NEAR(scene.sky.star_scale, 2e-6, 1e-20);
  EXPECT_NEAR(scene.sky.stars[0].illuminance, 1.0, 1e-14);
  EXPECT_NEAR(scene.sky.stars[1].illuminance, 0.01, 1e-16);
  EXPECT_NEAR(scene.sky.stars[2].illuminance, 10.0, 1e-13);
  EXPECT_EQ(scene.sky.stars[0].temperature, temperature_from_bv(0.65));
}

// The faintest star at film Y 0.02 in the middle pixel, whatever the picture's size and field of view.
TEST(SceneSky, StarsAreAsAnEyeSeesThemUnlessToldOtherwise) {
  for (const char* lens : {"fov = 60\n", "fov = 2\n", "projection = \"fisheye\"\nfov = 180\n",
                           "projection = \"equirectangular\"\n", "projection = \"mercator\"\n"}) {
    for (const char* size : {"[64, 48]", "[1920, 1080]"}) {
      const Scene scene = compiled("[film]\nresolution = " + std::string(size) + "\n" + camera + lens +
                                   "[background]\nstars = { count = 10 }\n");
      const Lens& of = scene.camera.lens;
      const double pixel = pixel_solid_angle(of, {0.5 * of.width, 0.5 * of.height});
      const double faintest = scene.sky.star_scale * std::pow(10.0, -0.4 * 6.5) / pixel;
      EXPECT_NEAR(faintest, 0.02, 1e-12) << lens << size;
    }
  }
  const auto scale = [](const std::string& film, const std::string& keys) {
    return compiled(film + camera + "[background]\nstars = { count = 10" + keys + " }\n").sky.star_scale;
  };
  EXPECT_EQ(scale("", ", brightness = 3"), 3e-6);
  EXPECT_EQ(scale("", ", absolute = true"), 2.54e-6);
  EXPECT_NEAR(scale("[film]\nexposure = 0.5\n", ", absolute = true, brightness = 4"), 5.08e-6, 1e-20);
  EXPECT_NEAR(scale("[film]\nexposure = 0.5\n", "") / scale("", ""), 0.5, 1e-15);
}

// docs/physics.md equation (9a); tests/unit/colour has the luminances.
TEST(SceneLights, AbsoluteBlackbodiesHaveTheirLuminanceTimesTheExposure) {
  const double kelvin_2042 = 598590.02557013636;
  const std::string film = "[film]\nexposure = 1e-5\n";
  const auto near = [&](const LinearRgb& rgb, double factor) {
    EXPECT_NEAR(luminance(rgb) / (1e-5 * kelvin_2042 * factor), 1.0, 1e-9);
  };
  const std::string body = "temperature = 2042\nabsolute = true\n";
  near(compiled(film + camera + "[background]\n" + body).sky.radiance.rgb, 1.0);
  near(compiled(film + camera + "[background]\nradiance = 0.25\n" + body).sky.radiance.rgb, 0.25);
  near(compiled(film + camera + "[[light]]\nintensity = 3\n" + body).lights[0].colour.rgb, 3.0);
  near(compiled(film + camera + "[[light]]\ntype = \"ambient\"\n" + body).lights[0].colour.rgb, 1.0);
  const auto emission = [&](const std::string& keys) {
    return compiled(film + camera + "[[object]]\nshape = \"plane\"\nmaterial = { " + keys +
                    "temperature = 2042, absolute = true }\n")
        .materials[0]
        .emission->rgb;
  };
  near(emission(""), 1.0);
  near(emission("emission = 0.5, "), 0.5);
}

TEST(SceneFilm, ExposureMultipliesEveryLight) {
  const std::string rest = camera +
                           "[background]\ncolor = [0.5, 0.25, 1]\n[[light]]\nintensity = \"2*t + 1\"\n"
                           "[[object]]\nshape = \"plane\"\nmaterial = { emission = 4 }\n";
  const Scene scene = compiled("[film]\nexposure = \"0.5 + t\"\n" + rest);
  EXPECT_EQ(scene.film.exposure, 0.5);
  EXPECT_EQ(scene.sky.radiance.rgb, (LinearRgb{0.25, 0.125, 0.5}));
  EXPECT_EQ(scene.lights[0].colour.rgb, LinearRgb{0.5});
  EXPECT_EQ(scene.materials[0].emission->rgb, LinearRgb{2.0});
}

TEST(SceneSky, MadeUpStarsAreEvenAndRepeatable) {
  const auto stars = [](const std::string& keys) {
    return compiled(camera + "[background]\nstars = { " + keys + " }\n").sky.stars;
  };
  const SharedVector<Star> sky = stars("count = 9000, seed = 1");
  ASSERT_EQ(sky.size(), 9000U);
  Vec3 sum{0.0};
  Vec3 squares{0.0};
  int brighter = 0;
  for (const Star& star : sky) {
    EXPECT_NEAR(glm::length(star.direction), 1.0, 1e-15);
    sum += star.direction;
    squares += star.direction * star.direction;
    if (star.illuminance > std::pow(10.0, -0.4 * 4.5)) ++brighter;
    EXPECT_GE(star.illuminance, std::pow(10.0, -0.4 * 6.5) * (1 - 1e-12));
  }
  // Each component has variance 1/3, its square 4/45: five standard deviations of the means.
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(sum[i] / 9000, 0.0, 5 * std::sqrt(1.0 / 3 / 9000));
    EXPECT_NEAR(squares[i] / 9000, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / 9000));
  }
  // A tenth of them is brighter than magnitude 4.5, two above the faintest.
  EXPECT_NEAR(brighter, 900, 5 * std::sqrt(900 * 0.9));
  EXPECT_EQ(stars("count = 9000, seed = 1")[77].direction, sky[77].direction);
  EXPECT_NE(stars("count = 9000, seed = 2")[77].direction, sky[77].direction);
  EXPECT_EQ(stars("count = 100, seed = 1")[77].direction, sky[77].direction);
}

}  // namespace
}  // namespace backlight
