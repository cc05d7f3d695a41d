// Every number of a scene may be another for each image: the table of keys is gone through, and for each
// number a formula of image_time gives, bit for bit, the picture of the number written out.
// Longer than 400 lines: it has a row for each number.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "backlight/scene/keys.h"
#include "backlight/scene/reader.h"
#include "rendering.h"

namespace backlight::test {
namespace {

// '@' in the text or an override is where the value stands.
struct Case {
  std::string key;  // table and name
  std::string text;
  std::vector<std::string> overrides;
  std::string first;   // at t = 1
  std::string second;  // at t = 2, of the same form; exact in binary, or the formula would round
};

const std::string base = R"toml([film]
resolution = [20, 14]
aovs = ["Z", "doppler", "emissionTime", "properTime", "P", "N", "objectId"]
[camera]
position = [0, 0.5, -5]
velocity = [0, 0, 0]
[background]
color = [0.1, 0.2, 0.4]
[[light]]
position = [-4, 6, -6]
intensity = 200
[[object]]
name = "ball"
shape = "sphere"
radius = 1
beta = [0, 0.25, 0.5]
material = "red"
[[object]]
shape = "plane"
position = [0, -1.5, 0]
)toml";

const std::string plain_red = "[material.red]\ncolor = [0.75, 0.25, 0.125]\n";

std::string object(const std::string& keys) {
  return plain_red + "[[object]]\nname = \"it\"\nmaterial = \"red\"\n" + keys + "\n";
}

std::string part(const std::string& keys) {
  return object(
      "shape = \"union\"\nposition = [1, 0, -1]\n[[object.part]]\nshape = \"box\"\nsize = [0.5, 0.5, 0.5]\n"
      "[[object.part]]\n" +
      keys);
}

std::string lamp(const std::string& keys) {
  return plain_red + "[[light]]\nname = \"it\"\n" + keys + "\n";
}

std::string material(const std::string& keys) {
  return "[material.red]\n" + keys + "\n";
}

// The ways of moving, in the table written by `text` or at the path of overrides.
void add_motion(std::vector<Case>& cases, const std::string& table, const std::string& text,
                const std::string& path) {
  const auto add = [&](const std::string& name, const std::vector<std::string>& keys,
                       const std::string& first, const std::string& second) {
    Case one{table + "." + name, text, {}, first, second};
    for (const std::string& key : keys) {
      if (path.empty()) {
        one.text += key + "\n";
      } else {
        one.overrides.push_back(path + "." + key);
      }
    }
    cases.push_back(one);
  };
  add("velocity", {"velocity = @"}, "[0.25, 0, 0.125]", "[0.5, 0.125, 0.125]");
  add("beta", {"beta = @"}, "[0.25, 0, 0.125]", "[0.5, 0.125, 0.125]");
  add("gamma", {"gamma = @", "along = [1, 0, 0.5]"}, "1.25", "1.5");
  add("celerity", {"celerity = @", "along = [1, 0, 0.5]"}, "0.25", "0.5");
  add("rapidity", {"rapidity = @", "along = [1, 0, 0.5]"}, "0.25", "0.5");
  add("along", {"rapidity = 0.5", "along = @"}, "[1, 0, 0]", "[1, 0.5, 0]");
}

void add_picture(std::vector<Case>& all) {
  all.push_back({".c", plain_red, {"c=@", "camera.velocity=[0.125, 0, 0]"}, "1", "2"});
  all.push_back({"film.resolution", plain_red, {"film.resolution=@"}, "[20, 14]", "[24, 12]"});
  all.push_back({"film.bounces",
                 "[material.red]\nglass = { index = 1.5 }\n",
                 {"film.bounces=@", "object.ball.beta=[0, 0, 0]"},
                 "1",
                 "4"});
  all.push_back({"film.samples", plain_red, {"film.samples=@"}, "2", "3"});
  all.push_back({"film.tolerance", plain_red, {"film.tolerance=@"}, "0.5", "0.03125"});
  all.push_back({"film.wavelengths", plain_red, {"film.wavelengths=@"}, "8", "16"});
  all.push_back({"film.exposure", plain_red, {"film.exposure=@"}, "0.5", "2"});
  all.push_back({"film.seed", plain_red, {"film.seed=@", "film.samples=2"}, "1", "2"});
  all.push_back({"camera.position", plain_red, {"camera.position=@"}, "[0, 0.5, -5]", "[0.5, 0.5, -4]"});
  all.push_back({"camera.look_at", plain_red, {"camera.look_at=@"}, "[0, 0, 0]", "[0.5, 0.25, 0]"});
  all.push_back({"camera.direction", plain_red, {"camera.direction=@"}, "[0, 0, 1]", "[0.125, 0, 1]"});
  all.push_back({"camera.up", plain_red, {"camera.up=@"}, "[0, 1, 0]", "[0.25, 1, 0]"});
  all.push_back({"camera.time", plain_red, {"camera.time=@"}, "1.5", "3"});
  all.push_back({"camera.world_time", plain_red, {"camera.world_time=@"}, "1.5", "3"});
  all.push_back({"camera.fov", plain_red, {"camera.fov=@"}, "60", "48"});
  const auto screen = [&all](const char* corner, const char* corners, const char* first, const char* second) {
    all.push_back({std::string("camera.screen.") + corner,
                   plain_red,
                   {std::string("camera.screen={ ") + corners + " }"},
                   first,
                   second});
  };
  // The lower left one stays on the circle over the other two: a right angle.
  screen("lower_left", "lower_left = @, lower_right = [-1, -0.75, -3], upper_left = [1, 0.75, -3]",
         "[0.75, -1, -3]", "[1, -0.75, -3]");
  screen("lower_right", "lower_left = [1, -1, -3], lower_right = @, upper_left = [1, 1, -3]", "[-1, -1, -3]",
         "[-2, -1, -3]");
  screen("upper_left", "lower_left = [1, -1, -3], lower_right = [-1, -1, -3], upper_left = @", "[1, 1, -3]",
         "[1, 2, -3]");
  all.push_back({"camera.stereo.separation", plain_red, {"camera.stereo={ separation = @ }"}, "0.25", "0.5"});
  const std::string ship = "[frame.ship]\nbeta = [0, 0, 0.125]\n" + plain_red;
  all.push_back({"rocket.acceleration",
                 ship,
                 {"camera.rocket={ acceleration = @, along = [0, 0, 1] }", "camera.position=[0, 0.5, -9]"},
                 "0.25",
                 "0.5"});
  all.push_back({"rocket.along",
                 ship,
                 {"camera.rocket={ acceleration = 0.25, along = @ }", "camera.position=[0, 0.5, -9]"},
                 "[0, 0, 1]",
                 "[0.5, 0, 1]"});
  add_motion(all, "camera", plain_red, "camera");
}

void add_lights(std::vector<Case>& all) {
  all.push_back({"light.position", lamp("position = @"), {}, "[1, 4, -4]", "[2, 4, -5]"});
  all.push_back({"light.temperature", lamp("position = [1, 4, -4]\ntemperature = @"), {}, "3000", "6000"});
  all.push_back({"light.color",
                 lamp("position = [1, 4, -4]\nintensity = 9\ncolor = @"),
                 {},
                 "[1, 0.5, 0.25]",
                 "[0.25, 1, 0.5]"});
  all.push_back({"light.distant.direction",
                 lamp("type = \"distant\"\ndirection = @"),
                 {},
                 "[0, -1, 0]",
                 "[0.5, -1, 0.25]"});
  const std::string spot = "type = \"spot\"\nposition = [1, 4, -4]\nintensity = 50\n";
  all.push_back(
      {"light.spot.direction", lamp(spot + "edge = 1\ndirection = @"), {}, "[0, -1, 0.5]", "[-0.25, -1, 1]"});
  all.push_back({"light.spot.angle", lamp(spot + "direction = [-0.25, -1, 1]\nangle = @"), {}, "40", "70"});
  all.push_back({"light.spot.edge", lamp(spot + "direction = [-0.25, -1, 1]\nedge = @"), {}, "0.25", "0.75"});
  add_motion(all, "light", lamp("position = [1, 4, -4]\nintensity = 50"), "");
  all.push_back(
      {"background.color", plain_red, {"background.color=@"}, "[0.5, 0.25, 0.25]", "[0.25, 0.25, 1]"});
  all.push_back({"background.radiance", plain_red, {"background.radiance=@"}, "0.5", "2"});
  all.push_back({"background.temperature",
                 plain_red,
                 {"background={ temperature = @, radiance = 0.5 }"},
                 "3000",
                 "6000"});
  const auto stars = [](const std::string& keys) {
    return std::vector<std::string>{"background.stars={ " + keys + " }"};
  };
  all.push_back({"background.stars.count", plain_red, stars("count = @"), "2000", "3000"});
  all.push_back({"background.stars.seed", plain_red, stars("count = 3000, seed = @"), "1", "2"});
  all.push_back({"background.stars.brightness", plain_red, stars("count = 3000, brightness = @"), "1", "2"});
  add_motion(all, "background", plain_red, "background");
  all.push_back({"effects.region.rect",
                 plain_red,
                 {"effects.region=[{ rect = @, doppler = false, searchlight = \"off\" }]"},
                 "[0.25, 0.25, 0.5, 0.75]",
                 "[0.25, 0.125, 0.75, 0.75]"});
}

void add_materials(std::vector<Case>& all) {
  all.push_back({"material.color", material("color = @"), {}, "[0.5, 0.25, 0.125]", "[0.25, 0.5, 0.75]"});
  all.push_back({"material.uv", material("color = [0.5, 0.5, 0.25]\nuv = @"), {}, "0", "1"});
  all.push_back({"material.ir",
                 material("color = [0.5, 0.5, 0.25]\nir = @"),
                 {"object.ball.beta=[0, 0, -0.75]"},
                 "0",
                 "1"});
  all.push_back({"material.specular", material("specular = @"), {}, "0", "0.5"});
  all.push_back({"material.mirror", material("mirror = @"), {}, "0.25", "0.75"});
  all.push_back({"material.glass.index",
                 material("glass = { index = @ }"),
                 {"object.ball.beta=[0, 0, 0]"},
                 "1.25",
                 "1.5"});
  all.push_back({"material.glass.tint",
                 material("glass = { index = 1.5, tint = @ }"),
                 {"object.ball.beta=[0, 0, 0]"},
                 "0.25",
                 "0.75"});
  all.push_back({"material.shininess", material("specular = 0.5\nshininess = @"), {}, "4", "16"});
  all.push_back({"material.emission", material("emission = @"), {}, "0.5", "0.75"});
  all.push_back({"material.temperature", material("emission = 1\ntemperature = @"), {}, "3000", "6000"});
  all.push_back({"material.emission_color",
                 material("emission = 1\nemission_color = @"),
                 {},
                 "[0.5, 0.25, 0.125]",
                 "[0.25, 0.5, 0.75]"});
  all.push_back({"material.checker.colors",
                 material("checker = { colors = @ }"),
                 {},
                 "[[0.5, 0.25, 0.125], [0.25, 0.5, 0.75]]",
                 "[[0.25, 0.25, 0.125], [0.25, 0.5, 0.5]]"});
  all.push_back({"material.checker.size",
                 material("checker = { colors = [[1, 1, 1], [0, 0, 0]], size = @ }"),
                 {},
                 "0.0625",
                 "0.125"});
  all.push_back({"spectrum.wavelengths",
                 material("spectrum = { wavelengths = @, values = [0.25, 0.75, 0.5] }"),
                 {},
                 "[400, 500, 700]",
                 "[400, 600, 700]"});
  all.push_back({"spectrum.values",
                 material("spectrum = { wavelengths = [400, 500, 700], values = @ }"),
                 {},
                 "[0.25, 0.75, 0.5]",
                 "[0.5, 0.25, 0.5]"});
  all.push_back({"lines.wavelengths",
                 material("emission = 1\nlines = { wavelengths = @, values = [1, 2] }"),
                 {},
                 "[500, 600]",
                 "[450, 600]"});
  all.push_back({"lines.values",
                 material("emission = 1\nlines = { wavelengths = [500, 600], values = @ }"),
                 {},
                 "[1, 2]",
                 "[2, 1]"});
}

void add_objects(std::vector<Case>& all) {
  const std::string small = "shape = \"sphere\"\nradius = 0.5\n";
  const std::string brick = "shape = \"box\"\nsize = [1, 0.5, 0.25]\n";
  const std::string here = "position = [1, 0, -1]\n";
  for (const auto& [table, make] : {std::pair{"object", &object}, std::pair{"object.part", &part}}) {
    const std::string name = table;
    all.push_back({name + ".position", make(small + "position = @"), {}, "[1, 0, -1]", "[0.5, 0.25, -1]"});
    all.push_back({name + ".rotate", make(brick + here + "rotate = @"), {}, "[0, 30, 0]", "[15, 30, 60]"});
    all.push_back({name + ".scale", make(small + here + "scale = @"), {}, "0.5", "1.5"});
    all.push_back({name + ".scale", make(small + here + "scale = @"), {}, "[0.5, 1, 1]", "[1, 1.5, 2]"});
  }
  add_motion(all, "object", object(small + "position = [1, 0, -1]"), "");
  const auto repeat = [&](const std::string& keys) {
    return object(small + here + "repeat = { " + keys + " }");
  };
  all.push_back(
      {"object.repeat.count", repeat("count = @, step = [0.25, 0.5, 0]"), {}, "[1, 1, 1]", "[2, 3, 1]"});
  all.push_back(
      {"object.repeat.step", repeat("count = [2, 1, 1], step = @"), {}, "[0.5, 0, 0]", "[0, 0.5, 0.5]"});
  const auto shape = [&](const std::string& kind, const std::string& key, const std::string& others,
                         const std::string& first, const std::string& second) {
    const std::string keys = here + "shape = \"" + kind + "\"\n" + key + " = @\n" + others;
    all.push_back({"object." + kind + "." + key, object(keys), {}, first, second});
  };
  shape("sphere", "radius", "", "0.5", "0.75");
  shape("box", "size", "", "[0.5, 0.75, 1]", "[1, 0.75, 1]");
  shape("cylinder", "radius", "height = 1", "0.5", "0.75");
  shape("cylinder", "height", "radius = 0.5", "0.5", "1.25");
  shape("cone", "radius", "height = 1", "0.5", "0.75");
  shape("cone", "top_radius", "radius = 0.75\nheight = 1", "0.25", "0.5");
  shape("cone", "height", "radius = 0.5", "0.5", "1.25");
  shape("torus", "major", "minor = 0.25", "0.5", "0.75");
  shape("torus", "minor", "major = 0.75", "0.125", "0.25");
  shape("disk", "radius", "rotate = [60, 0, 0]", "0.5", "0.75");
  shape("quadric", "coefficients", "", "[1, 1, 1, 0, 0, 0, 0, 0, 0, -0.25]",
        "[1, 2, 1, 0.5, 0, 0, 0, 0, 0, -0.5]");
  const std::string formula = "f = \"x^2 + y^2 + z^2 - 0.5\"\n";
  shape("implicit", "bounds", formula, "[[-1, -1, -1], [1, 1, 1]]", "[[-0.25, -1, -1], [1, 0.25, 1]]");
  const std::string two = "shape = \"union\"\n" + here;
  const std::string parts =
      "[[object.part]]\nshape = \"sphere\"\nradius = 0.5\n[[object.part]]\nshape = \"sphere\"\n"
      "radius = 0.5\nposition = [0.5, 0.5, 0]\n";
  all.push_back({"object.union.blend", object(two + "blend = @\n" + parts), {}, "0.125", "0.5"});
  all.push_back({"object.union.bounds",
                 object(two + "blend = 0.25\nbounds = @\n" + parts),
                 {},
                 "[[-1, -1, -1], [1, 1, 1]]",
                 "[[-0.25, -1, -1], [1, 0.25, 1]]"});
  all.push_back(
      {"frame.origin",
       plain_red + "[frame.f]\nbeta = [0.25, 0, 0]\norigin = @\n[[object]]\n" + small + "frame = \"f\"\n",
       {},
       "[0, 0, -1]",
       "[0.5, 0, -1]"});
  all.push_back({"frame.origin_time",
                 plain_red + "[frame.f]\nbeta = [0.25, 0, 0]\norigin_time = @\n[[object]]\n" + small +
                     "frame = \"f\"\n",
                 {},
                 "0.5",
                 "1"});
  add_motion(all, "frame",
             plain_red + "[[object]]\n" + small + "position = [0.5, 0, -1]\nframe = \"f\"\n[frame.f]\n", "");
}

std::vector<Case> cases() {
  std::vector<Case> all;
  add_picture(all);
  add_lights(all);
  add_materials(all);
  add_objects(all);
  return all;
}

// Those that cannot, or that other tests are about; docs/scene-reference.md says so of each.
const std::map<std::string, std::string>& exceptions() {
  static const std::map<std::string, std::string> all{
      {"animation.fps", "t is made of it"},
      {"animation.frames", "t is made of it"},
      {"light.point.intensity", "t is the lamp's own time: blinking_lamp_test.cpp"},
      {"light.spot.intensity", "t is the lamp's own time, as of a point light"},
      {"light.distant.irradiance", "t is the lamp's own time"},
      {"light.ambient.radiance", "t is the time of the surface's frame"},
      {"object.implicit.f", "t is the object's own time"},
      {"object.implicit.matter_velocity", "t is the object's own time"},
      {"object.visible", "t is the matter's own time, and no number hides it"},
  };
  return all;
}

// Each number of `first` that `second` has otherwise becomes a formula that goes from one to the other.
std::string moving(const std::string& first, const std::string& second,
                   const std::string& clock = "image_time") {
  const auto is_number = [](char c) {
    return std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
  };
  std::string text;
  std::size_t j = 0;
  for (std::size_t i = 0; i < first.size();) {
    if (!is_number(first[i])) {
      text += first[i++];
      ++j;
      continue;
    }
    const auto take = [&](const std::string& from, std::size_t& at) {
      const std::size_t begin = at;
      while (at < from.size() && is_number(from[at])) ++at;
      return from.substr(begin, at - begin);
    };
    const std::string a = take(first, i);
    const std::string b = take(second, j);
    text += a == b ? a : "\"" + a + " + (" + b + " - (" + a + "))*(" + clock + " - 1)\"";
  }
  return text;
}

std::string put(std::string text, const std::string& value) {
  if (const std::size_t at = text.find('@'); at != std::string::npos) text.replace(at, 1, value);
  return text;
}

void remove(std::string& text, const std::string& what) {
  if (const std::size_t at = text.find(what); at != std::string::npos) text.erase(at, what.size());
}

// The base has a camera at rest and a background of a colour; what would contradict them replaces them.
std::string base_for(const std::string& key) {
  std::string text = base;
  const std::set<std::string> motion{"camera.velocity", "camera.beta",     "camera.gamma",
                                     "camera.celerity", "camera.rapidity", "camera.along"};
  if (motion.contains(key) || key.starts_with("rocket")) remove(text, "velocity = [0, 0, 0]\n");
  if (key == "background.temperature") remove(text, "[background]\ncolor = [0.1, 0.2, 0.4]\n");
  return text;
}

Rendering rendered(const Case& one, const std::string& value, double time) {
  RenderChoices choices{.time = time};
  for (const std::string& text : one.overrides) choices.overrides.push_back(put(text, value));
  return render_text(base_for(one.key) + put(one.text, value), choices);
}

bool same_bits(const Image& a, const Image& b) {
  if (a.layout().data != b.layout().data || a.channel_count() != b.channel_count()) return false;
  for (std::size_t channel = 0; channel < a.channel_count(); ++channel) {
    const auto x = a.plane(channel);
    if (std::memcmp(x.data(), b.plane(channel).data(), x.size_bytes()) != 0) return false;
  }
  return true;
}

TEST(EveryNumber, MovesWithTime) {
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.key);
    try {
      const std::string formula = moving(one.first, one.second);
      const Image early = rendered(one, one.first, 1.0).image;
      EXPECT_TRUE(same_bits(rendered(one, formula, 1.0).image, early)) << formula;
      EXPECT_TRUE(same_bits(rendered(one, formula, 2.0).image, rendered(one, one.second, 2.0).image))
          << formula;
      EXPECT_FALSE(same_bits(rendered(one, one.second, 1.0).image, early)) << "the key does nothing here";
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

// What has neither a clock of its own nor is about the picture is told of, unless it is written so.
TEST(EveryNumber, WithoutAClockOfItsOwnIsToldOf) {
  const auto warned = [](const Case& one, const std::string& clock) {
    std::vector<std::string> overrides;
    for (const std::string& text : one.overrides)
      overrides.push_back(put(text, moving(one.first, one.second, clock)));
    const std::string text = base_for(one.key) + put(one.text, moving(one.first, one.second, clock));
    const ReadResult result = read_scene_text(text, "scene.toml", overrides, {});
    return std::ranges::any_of(result.diagnostics.all(), [](const Diagnostic& d) {
      return d.message.find("is evaluated anew for each image") != std::string::npos;
    });
  };
  int told = 0;
  for (const Case& one : cases()) {
    SCOPED_TRACE(one.key);
    const std::size_t dot = one.key.rfind('.');
    const KeyTable* table = find_table(one.key.substr(0, dot));
    ASSERT_NE(table, nullptr);
    const Key* key = find_key(*table, one.key.substr(dot + 1));
    ASSERT_NE(key, nullptr);
    EXPECT_FALSE(warned(one, "image_time"));
    EXPECT_EQ(warned(one, "t"), key->clock == Clock::anew);
    told += key->clock == Clock::anew ? 1 : 0;
  }
  EXPECT_GT(told, 20);
}

// A new key without a case fails here.
TEST(EveryNumber, IsAmongTheCases) {
  std::set<std::string> covered;
  for (const Case& one : cases()) covered.insert(one.key);
  const std::set<ValueKind> numeric{ValueKind::number, ValueKind::numbers, ValueKind::colours,
                                    ValueKind::points, ValueKind::formula};
  for (const KeyTable& table : key_tables()) {
    for (const Key& key : table.keys) {
      const bool has_numbers =
          std::ranges::any_of(key.forms, [&](const ValueForm& form) { return numeric.contains(form.kind); });
      const std::string name = std::string(table.name) + "." + std::string(key.name);
      if (!has_numbers) continue;
      EXPECT_TRUE(covered.contains(name) || exceptions().contains(name)) << name;
      EXPECT_FALSE(covered.contains(name) && exceptions().contains(name)) << name;
    }
  }
}

TEST(EveryNumber, OfTheAnimationItselfSaysWhyItCannotMove) {
  for (const char* text : {"animation.fps=\"25 + t\"", "animation.frames=[1, \"frame\"]"}) {
    try {
      render_text(base + plain_red + "[animation]\n", {.overrides = {text}});
      ADD_FAILURE() << text;
    } catch (const std::exception& error) {
      EXPECT_NE(std::string(error.what()).find("may not depend on t, frame or image_time"), std::string::npos)
          << error.what();
    }
  }
}

}  // namespace
}  // namespace backlight::test
