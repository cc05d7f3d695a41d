// The keys of what shines, and of what is shown of it: docs/scene-reference.md is made from this text.
#include "key_builders.h"

namespace backlight::key_builders {
namespace {

KeyTable light() {
  KeyTable table{
      "light",
      "[[light]]",
      "A light, at rest in its frame. Its strength may be an expression of `t`, which is then the light's "
      "own time: a "
      "flickering lamp; below zero the lamp is off. At most one of `temperature`, `color` and `spectrum` is "
      "given; without them, and without `lines`, it is D65, white.",
      {text("name", "For error messages and `-D light.NAME.key=value`."),
       choice("type", std::string("point"), {"point", "spot", "distant", "ambient"},
              "`point`: a lamp without size. `spot`: the same, which shines into a cone. `distant`: parallel "
              "light from infinity. `ambient`: the same "
              "irradiance on "
              "every surface, in the surface's own rest frame (a convenience; no such light exists), its "
              "strength by the "
              "time of that frame."),
       of_motion(numbers("position", 3, std::vector<double>{0, 0, 0}, "length", "Where it is.")),
       boolean("shadows", true,
               "Whether what stands in its way hides it. Without, no shadow rays are traced for it: a fill "
               "light. An `ambient` light throws none."),
       number("temperature", Nothing{}, "K", "A blackbody's light, of the strength given.", above(0)),
       boolean("absolute", false,
               "Beside `temperature`: the strength says how large the blackbody is, and its luminance is "
               "what Planck's law gives, in cd/m². `intensity` is then the area that a point light shows "
               "(a ball's is π times its radius squared), `irradiance` the solid angle of a distant one in "
               "sr (6.8e-5 for the sun), `radiance` the part of the sky that an ambient one fills. "
               "`exposure` of `[film]` makes film values of it."),
       numbers("color", 3, Nothing{}, "", "Linear red, green, blue (Rec.709), multiplied by the strength.",
               at_least(0)),
       structured("spectrum", {{ValueKind::table, 0, "spectrum"}, {ValueKind::path}},
                  "Relative power by wavelength, scaled so that its film Y is the strength: a table, or a "
                  "CSV file of "
                  "wavelengths in nm and values. Outside the given wavelengths the end values are kept. "
                  "However narrow its peaks are, they are seen at any shift."),
       structured("lines", {{ValueKind::table, 0, "lines"}},
                  "Light of single wavelengths, alone or beside `spectrum`: a sodium lamp, a laser. The film "
                  "Y of all of it together, at rest, is the strength.")},
      "type"};
  add_motion_or_frame(table.keys);
  add_rocket(table.keys);
  return table;
}

std::vector<KeyTable> light_types() {
  return {
      {"light.point",
       "[[light]]",
       "A white surface facing it at distance r, at rest, has film Y = intensity/(π r²).",
       {own(number("intensity", 1.0, "film Y · length²", "Radiant intensity.", at_least(0)))},
       ""},
      {"light.spot",
       "[[light]]",
       "A point light whose light leaves within a cone, in the lamp's own frame. Of a lamp in motion the "
       "cone is "
       "seen by others as aberration has it: narrower ahead, wider behind.",
       {own(numbers(
            "direction", 3, Required{}, "",
            "The cone's axis, in the lamp's rest frame; of any length but zero. Formulas of `t` turn it, as "
            "a "
            "lighthouse's; while they are all zero it is dark. A lamp on a path or with a "
            "`rocket` keeps it, along the axes of its frame carried by the pure boost to its velocity.")),
        number("angle", 60.0, "degrees", "The full angle of the cone, beyond which it is dark.",
               {.least = 0, .greatest = 360, .above_least = true}),
        number("edge", 0.0, "",
               "The share of the angle over which the light fades, at the cone's rim; 0 is a sharp edge, 1 "
               "fades "
               "from the axis on.",
               between(0, 1)),
        own(number(
            "intensity", 1.0, "film Y · length²",
            "Radiant intensity within the cone: on its axis it shines as a point light of this intensity.",
            at_least(0)))},
       ""},
      {"light.distant",
       "[[light]]",
       "A white surface facing it, at rest to it, has film Y = irradiance/π.",
       {numbers("direction", 3, Required{}, "", "Where its light travels to; of any length but zero."),
        own(number("irradiance", 1.0, "film Y", "Irradiance of a surface that faces it.", at_least(0)))},
       ""},
      {"light.ambient",
       "[[light]]",
       "A white surface has film Y = radiance from it.",
       {own(number("radiance", 1.0, "film Y", "Radiance from every side.", at_least(0)))},
       ""}};
}

KeyTable background() {
  KeyTable table{
      "background",
      "[background]",
      "What is at infinity in every direction, at rest in its frame; black without `color`, `texture` or "
      "`temperature`, of which at most one is given. With one of these or `stars`, be it black, the picture "
      "is opaque where a ray meets nothing (A = 1); else A is 0 there.",
      {numbers("color", 3, Nothing{}, "", "Radiance: linear red, green, blue (Rec.709).", at_least(0)),
       structured("texture", {{ValueKind::path}},
                  "An equirectangular image of radiances: the middle of it is seen along +z, the upper edge "
                  "along +y, the right half towards -x, which is to the right of a viewer who looks along "
                  "+z with y up."),
       number("temperature", Nothing{}, "K", "A blackbody's radiance, of film Y 1 at rest unless `absolute`.",
              above(0)),
       boolean("absolute", false,
               "Beside `temperature`: the film Y is the blackbody's luminance in cd/m² times `exposure` of "
               "`[film]`. So the microwave background, 2.725 K, is black at rest, and glows when it is met "
               "at γ = 1000."),
       number("radiance", 1.0, "film Y",
              "Multiplies the three above; with `absolute` it is an emissivity, without a unit.",
              at_least(0)),
       structured("stars", {{ValueKind::path}, {ValueKind::table, 0, "background.stars"}},
                  "Stars at infinity, besides. A path is short for `{ file = path }`.")},
      ""};
  add_motion_or_frame(table.keys);
  return table;
}

KeyTable stars() {
  return {
      "background.stars",
      "stars = \"FILE\" or stars = { ... }",
      "Stars, from a catalogue (`file`) or made up (`count`). A catalogue is a CSV file with the header "
      "`right_ascension,declination,magnitude,b_minus_v` (degrees, degrees, visual magnitude, colour index). "
      "The "
      "north pole is +y; right ascension 0 on the equator is seen along +z and 90 degrees along +x: the sky "
      "as it "
      "is seen from the Earth, not its mirror image. A star is a blackbody at the temperature of its colour "
      "index.",
      {structured("file", {{ValueKind::path}}, "The catalogue."),
       number(
           "count", Nothing{}, "",
           "How many made-up stars: evenly spread over the sky, ten times as many for every two magnitudes "
           "fainter, down to magnitude 6.5.",
           whole(1, 1e7)),
       number("seed", 0.0, "", "Another number gives other made-up stars.", whole(0, 4294967295.0)),
       number("brightness", Nothing{}, "",
              "With 1, a star of magnitude 0 has an illuminance of 1e-6 film Y · sr: film Y 1 in a pixel of "
              "1e-6 sr. A magnitude more is a factor 10^-0.4. Without it the stars are as an eye in the dark "
              "sees them, whatever the resolution and the field of view: at rest, one of magnitude 6.5 has "
              "film Y 0.02 in a pixel as large as the one in the middle, which is just visible, and one of "
              "magnitude 2.25 has film Y 1.",
              at_least(0)),
       boolean("absolute", false,
               "A star of magnitude 0 has an illuminance of 2.54e-6 lx, so film Y 2.54e-6 cd/m² · sr times "
               "`exposure` of `[film]`; `brightness`, 1 unless it is given, multiplies it.")},
      ""};
}

std::vector<Key> effect_keys() {
  return {
      boolean("light_delay", true,
              "Light takes time to reach the camera. Without it, everything is seen where it is now in the "
              "camera's frame, without any change of colour or brightness on the way to the camera."),
      boolean("doppler", true, "Colours are shifted."),
      choice("searchlight", std::string("exact"), {"exact", "paper", "off"},
             "The change of brightness. `exact`: D⁴, nature's. `paper`: D · γ · D², which counts time "
             "dilation alone "
             "in the rate of arrival. `off`: none. It sets the three keys below, each of which may be given "
             "besides."),
      boolean("energy", Nothing{}, "The factor D: photon energy."),
      choice("rate", Nothing{}, {"exact", "dilation", "off"}, "The factor D, or γ, or 1: rate of arrival."),
      boolean("solid_angle", Nothing{}, "The factor D²: aberration of solid angle.")};
}

KeyTable effects() {
  KeyTable table{"effects", "[effects]", "Which effects are shown. The defaults are nature's.", effect_keys(),
                 ""};
  table.keys.push_back(structured("region", {{ValueKind::tables, 0, "effects.region"}},
                                  "Other effects in a part of the image."));
  return table;
}

KeyTable region() {
  KeyTable table{
      "effects.region",
      "[[effects.region]]",
      "Other effects in a part of the image. Keys that are not given are those of `[effects]`. Where regions "
      "overlap, the last one counts.",
      {numbers("rect", 4, Required{}, "",
               "x0, y0, x1, y1: left, upper, right and lower edge as fractions of the image.",
               between(0, 1))},
      ""};
  for (Key& key : effect_keys()) {
    key.value = Nothing{};
    table.keys.push_back(std::move(key));
  }
  return table;
}

}  // namespace

std::vector<KeyTable> light_tables() {
  std::vector<KeyTable> tables{light()};
  for (KeyTable& type : light_types()) tables.push_back(std::move(type));
  for (const KeyTable& table : {background(), stars()}) tables.push_back(table);
  set_clocks(tables);
  for (const KeyTable& table : {effects(), region()}) tables.push_back(table);
  return tables;
}

}  // namespace backlight::key_builders
