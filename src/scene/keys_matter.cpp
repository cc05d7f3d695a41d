// The keys of what there is to be seen: docs/scene-reference.md is made from this text.
#include "key_builders.h"

namespace backlight::key_builders {
namespace {

KeyTable frame() {
  KeyTable table{
      "frame",
      "[frame.NAME]",
      "A named rest frame: its axes are the world's carried by the pure boost to its velocity. `\"world\"` "
      "always exists.",
      {},
      ""};
  add_motion(table.keys);
  table.keys.push_back(numbers("origin", 3, std::vector<double>{0, 0, 0}, "length",
                               "Where the frame's own origin is at the frame's time 0."));
  table.keys.push_back(number("origin_time", 0.0, "s", "When that is."));
  table.keys.push_back({"within",
                        {{ValueKind::reference, 0, "frame"}},
                        std::string("world"),
                        "",
                        "The frame in whose coordinates the velocity, `origin` and `origin_time` are given.",
                        {},
                        {}});
  return table;
}

KeyTable material() {
  return {
      "material",
      "[material.NAME] or material = { ... }",
      "What a surface is made of, in its rest frame: a Lambert reflector of one of `color`, `texture`, "
      "`checker` "
      "and `spectrum` (without any of them, a grey of 0.8), with a Phong lobe, and with light of its own. "
      "Where a formula of the "
      "matter's own time leaves what is allowed, a share of light is the nearer of 0 and 1, a negative "
      "emission "
      "is none, and at a temperature of 0 or less nothing is emitted; where it has no value, the pixel is "
      "not "
      "finite, and counted so.",
      {own(numbers("color", 3, Nothing{}, "", "Reflectance: linear red, green, blue (Rec.709).",
                   between(0, 1))),
       structured("texture", {{ValueKind::path}},
                  "An image file of reflectances, over the shape's texture coordinates."),
       structured("checker", {{ValueKind::table, 0, "material.checker"}}, "A pattern of two reflectances."),
       structured(
           "spectrum", {{ValueKind::table, 0, "spectrum"}, {ValueKind::path}},
           "Reflectance by wavelength: a table, or a CSV file of wavelengths in nm and values. Outside the "
           "given wavelengths the end values are kept."),
       own(number("uv", Nothing{}, "",
                  "Reflectance in the ultraviolet, which the Doppler effect may bring into view. Without it, "
                  "that of "
                  "the violet end is kept.",
                  between(0, 1))),
       own(number("ir", Nothing{}, "",
                  "Reflectance in the infrared; without it, that of the red end is kept.", between(0, 1))),
       own(number("specular", 0.0, "", "The share of the light that the Phong lobe reflects.",
                  between(0, 1))),
       own(number("shininess", 50.0, "", "The exponent of the Phong lobe.", above(0))),
       {"mirror",
        {{ValueKind::number}, {ValueKind::numbers, 3}},
        Nothing{},
        "",
        "The share of the light that the surface reflects as a mirror does: a number, or `[red, green, "
        "blue]`. "
        "What is seen in it comes on top of what the other keys say; a mirror of which none of `color`, "
        "`texture`, `checker` and `spectrum` is written reflects nothing else.",
        between(0, 1),
        {}},
       structured(
           "glass", {{ValueKind::table, 0, "material.glass"}},
           "What is within the surface, through which light goes; it has to enclose something and to be at "
           "rest in its frame."),
       own(number(
           "emission", 0.0, "film Y",
           "Own radiance, added to what is reflected; with `absolute` an emissivity, without a unit, and 1 "
           "unless it is given.",
           at_least(0))),
       own(number("temperature", Nothing{}, "K", "The emission is a blackbody's of this temperature.",
                  above(0))),
       boolean("absolute", false,
               "Beside `temperature`: the film Y of the emission is the blackbody's luminance in cd/m² times "
               "`emission` and `exposure` of `[film]`."),
       own(numbers("emission_color", 3, Nothing{}, "", "The emission's color, which `emission` multiplies.",
                   at_least(0))),
       structured("emission_spectrum", {{ValueKind::table, 0, "spectrum"}, {ValueKind::path}},
                  "The emission's relative power by wavelength, scaled so that its film Y is `emission`: as "
                  "a light's `spectrum`."),
       structured("lines", {{ValueKind::table, 0, "lines"}},
                  "Emission of single wavelengths, alone or beside `emission_spectrum`: a glowing gas. The "
                  "film Y of all of it together, at rest, is `emission`.")},
      ""};
}

KeyTable glass() {
  return {
      "material.glass",
      "glass = { ... }",
      "Glass, water or any other clear body. Light is refracted and reflected at its surface by the laws of "
      "Snell and Fresnel (unpolarised), in the frame of the glass; both parts are followed until the rest "
      "is too faint to be seen. Inside, light takes `index` times as long. Lamps shine straight through it, "
      "less what its surfaces reflect and its tint takes.",
      {number("index", Required{}, "", "Of refraction, the same at all wavelengths: glass 1.5, water 1.33.",
              between(1, 100)),
       {"tint",
        {{ValueKind::number}, {ValueKind::numbers, 3}},
        1.0,
        "",
        "The share of light that a way of one unit of length leaves: a number, or `[red, green, blue]`.",
        between(0, 1),
        {}}},
      ""};
}

KeyTable checker() {
  return {"material.checker",
          "checker = { ... }",
          "Squares of two colors in turn, over the shape's texture coordinates.",
          {{"colors",
            {{ValueKind::colours, 2}},
            Required{},
            "",
            "Two reflectances, each `[red, green, blue]`: `[[1, 1, 1], [0.1, 0.1, 0.1]]`.",
            between(0, 1),
            {},
            Clock::own},
           number("size", 1.0, "texture coordinates",
                  "Edge of a square. A plane's texture coordinates are lengths; the others go from 0 to 1.",
                  above(0))},
          ""};
}

KeyTable spectrum() {
  return {"spectrum",
          "spectrum = { ... }",
          "Values by wavelength, joined by straight lines.",
          {numbers("wavelengths", 0, Required{}, "nm", "In rising order.", above(0)),
           numbers("values", 0, Required{}, "", "One for each wavelength.", at_least(0))},
          ""};
}

KeyTable lines() {
  return {"lines",
          "lines = { ... }",
          "Light of single wavelengths. Each arrives at the wavelength that the motions give, with all of "
          "its power, and is seen as the observer sees that wavelength.",
          {numbers("wavelengths", 0, Required{}, "nm", "At rest, in any order.", above(0)),
           numbers("values", 0, Required{}, "",
                   "The power of each, relative to the others'. Beside a spectrum, a line of value 1 has as "
                   "much power as a spectrum of value 1 has over one nanometre.",
                   at_least(0))},
          ""};
}

// What an object and a part of one have in common. `centre`: what their position is.
void add_shape_keys(std::vector<Key>& keys, std::string_view centre, std::string_view material) {
  keys.push_back({"shape",
                  {{ValueKind::choice}},
                  Required{},
                  "",
                  "Which surface; its own keys are in the tables below.",
                  {},
                  {"sphere", "box", "cylinder", "cone", "torus", "disk", "plane", "quadric", "implicit",
                   "mesh", "union", "intersection", "difference"}});
  keys.push_back(of_motion(numbers("position", 3, std::vector<double>{0, 0, 0}, "length", centre)));
  keys.push_back(of_motion(numbers("rotate", 3, std::vector<double>{0, 0, 0}, "degrees",
                                   "Turned about the x axis, then about y, then about z (fixed axes).")));
  keys.push_back({"scale",
                  {{ValueKind::number}, {ValueKind::numbers, 3}},
                  1.0,
                  "",
                  "Stretched along its own axes before it is turned: a number or `[x, y, z]`, not zero.",
                  {.magnitude = greatest_magnitude},
                  {},
                  Clock::motion});
  keys.push_back(structured(
      "material", {{ValueKind::reference, 0, "material"}, {ValueKind::table, 0, "material"}}, material));
}

KeyTable object() {
  KeyTable table{
      "object",
      "[[object]]",
      "A surface, at rest in its frame. With a velocity of its own it makes its own rest frame, whose origin "
      "it sits "
      "at and which passes `position` at world time 0. Sizes are always rest-frame sizes. Surfaces are "
      "two-sided.",
      {text("name",
            "For error messages, `-D object.NAME.key=value` and the list that `backlight check` gives.")},
      "shape"};
  add_shape_keys(
      table.keys, "Where its centre is.",
      "The name of a `[material.NAME]`, or its keys; without it, a grey of reflectance 0.8. Of a mesh, "
      "`\"file\"`: those of its file.");
  table.keys.push_back(boolean("casts_shadow", true,
                               "Whether it is in the way of light, its own surface's included. False: it "
                               "is seen and lit like any other, and hides no lamp: the bulb about one."));
  table.keys.push_back(
      own(number("visible", Nothing{}, "",
                 "A formula of `t`, the own time of its matter: it is there while that is positive. A "
                 "flash, a door that shuts, a digit of a clock. Without it, it is always there.",
                 {})));
  table.keys.push_back(structured("repeat", {{ValueKind::table, 0, "object.repeat"}},
                                  "Copies of it, all at rest in the same frame and of the same `objectId`."));
  add_motion_or_frame(table.keys);
  add_rocket(table.keys);
  return table;
}

KeyTable part() {
  KeyTable table{
      "object.part",
      "[[object.part]]",
      "A solid that another is made of: any shape that encloses something (all but the disk), or a "
      "union, intersection or difference again, whose parts are `[[object.part.part]]`. It moves with "
      "its object.",
      {text("name", "For error messages and `-D object.NAME.part.PART.key=value`.")},
      "shape",
      "object"};
  add_shape_keys(table.keys, "Where its centre is, in the coordinates of what it is part of.",
                 "As an object's; without it, the material of what it is part of.");
  return table;
}

KeyTable repeat() {
  return {
      "object.repeat",
      "repeat = { ... }",
      "A lattice of copies: the copy i, j, k is displaced by `[i, j, k]` times `step`, counted from 0.",
      {numbers("count", 3, Required{}, "", "How many along x, y and z.", whole(1, 1e6)),
       numbers("step", 3, Required{}, "length", "The distance from one to the next, in the frame's axes.")},
      ""};
}

Key length(std::string_view name, DefaultValue value, std::string_view meaning, Range range) {
  return number(name, std::move(value), "length", meaning, range);
}

Key unresolved(
    const char* meaning =
        "What becomes of a root that is certain to be one, or within rounding of one, but is not crossed in "
        "one "
        "place: of even multiplicity, where the surface is only touched, or so near to another that rounding "
        "hides which. `take`: it is seen; `skip`: the ray goes on. They are counted in `--stats` and shown "
        "by "
        "the channel `unresolved`. A pole, a jump, the edge of a domain, or what does not come down to 0 "
        "continuously, is never a surface.") {
  return choice("unresolved", std::string("take"), {"take", "skip"}, meaning);
}

std::vector<KeyTable> shapes() {
  const std::string_view heading = "[[object]]";
  std::vector<KeyTable> tables;
  const auto shape = [&](std::string_view name, std::string_view meaning, std::vector<Key> keys) {
    tables.push_back({name, heading, meaning, std::move(keys), ""});
  };
  shape("object.sphere",
        "A sphere about the origin. Texture: longitude and latitude about y; u = 0.5 along +z, v = 0 at the "
        "north "
        "pole (+y).",
        {length("radius", Required{}, "Radius.", above(0))});
  shape("object.box",
        "A box. Texture: each face from 0 to 1, upright on the four sides for a viewer outside.",
        {numbers("size", 3, Required{}, "length", "Full extents along x, y, z.", above(0))});
  shape("object.cylinder",
        "A cylinder about the y axis, with caps. Texture: u around as for the sphere, v from the top down.",
        {length("radius", Required{}, "Radius.", above(0)),
         length("height", Required{}, "Full height.", above(0))});
  shape("object.cone", "A cone about the y axis, with caps. Texture: as the cylinder's.",
        {length("radius", Required{}, "Radius at the bottom.", at_least(0)),
         length("top_radius", 0.0, "Radius at the top.", at_least(0)),
         length("height", Required{}, "Full height.", above(0))});
  shape("object.torus",
        "A torus about the y axis. Texture: u around the axis as for the sphere, v around the tube, 0.5 on "
        "the outer "
        "equator.",
        {length("major", Required{}, "Radius of the circle in the middle of the tube.", above(0)),
         length("minor", Required{}, "Radius of the tube, less than `major`.", above(0))});
  shape("object.disk", "A flat disk; its normal is y. Texture: the disk fills the middle of the unit square.",
        {length("radius", Required{}, "Radius.", above(0))});
  shape("object.plane", "The plane y = 0, infinite. Texture: u = x, v = z, repeating.", {});
  shape(
      "object.quadric",
      "c0 x² + c1 y² + c2 z² + c3 xy + c4 xz + c5 yz + c6 x + c7 y + c8 z + c9 = 0, infinite unless it is an "
      "ellipsoid. Texture: as the plane's.",
      {numbers("coefficients", 10, Required{}, "", "c0 to c9.", {.magnitude = greatest_magnitude})});
  shape(
      "object.implicit",
      "Where a formula is zero, within bounds: f(x, y, z, t) = 0, solid where f < 0. Every root along a ray "
      "is "
      "found, with a proof by interval arithmetic that there is no other; no step size, accuracy or gradient "
      "need be given. Poles, jumps and edges of domains are no surface. On its own the surface is an open "
      "sheet "
      "where the bounds cut it; as a part of a solid (a union of one part will do) flat faces close it "
      "there. "
      "Texture: longitude and latitude about y, as the sphere's.",
      {{"f",
        {{ValueKind::formula}},
        Required{},
        "",
        "Of `x`, `y`, `z` (its own coordinates) and `t` (its own proper time in seconds: it may pulsate), "
        "with what every expression may use.",
        {},
        {},
        Clock::own},
       points("bounds", 2, "length",
              "Two opposite corners of a box in its own coordinates: nothing is seen of the surface outside. "
              "Without it, a box is sought outside which f is proved to be positive (or negative): that "
              "succeeds for formulas of + - * /, powers, roots, abs, min and max that grow in every "
              "direction, also with sin, cos, atan, tanh, floor and mod added. What cannot be proved is an "
              "error."),
       {"matter_velocity",
        {{ValueKind::formula, 3}},
        Nothing{},
        "length/time",
        "Which matter the surface of an `f` of `t` is: the velocity of the matter at x, y, z at `t`, in its "
        "own "
        "coordinates. Its colours, brightness, light and own time are those of matter that moves so. Without "
        "it the "
        "matter is at rest, and the surface goes through it like a wave.",
        {},
        {},
        Clock::own},
       unresolved()});
  shape("object.mesh",
        "Triangles from a file, in the file's own coordinates. `material = \"file\"` takes the materials of "
        "the "
        "file: colours, textures and emission. A ray never slips through between two triangles. Triangles "
        "without "
        "an area are left out. As a part of a solid it has to be closed. Texture: its own; 0 where it has "
        "none.",
        {{"file",
          {{ValueKind::path}},
          Required{},
          "",
          "Wavefront OBJ (.obj, in double precision), PLY (.ply), STL (.stl) or glTF 2 (.gltf, .glb)."},
         boolean(
             "smooth", true,
             "Lit as a curved surface, by normals that go over from corner to corner: those of the file or, "
             "where it has none, those of its faces averaged where they meet at less than 40 degrees. False: "
             "flat triangles. What is hit, and shadows, are the triangles' either way.")});
  const auto solid = [&](std::string_view name, std::string_view meaning, std::vector<Key> more) {
    std::vector<Key> keys{
        structured("part", {{ValueKind::tables, 0, "object.part"}}, "What it is made of, at least one.")};
    keys.front().value = Required{};
    for (Key& key : more) keys.push_back(std::move(key));
    shape(name, meaning, std::move(keys));
  };
  solid("object.union",
        "All parts together. Faces of two parts that coincide (to within their rounding errors) count once: "
        "solids that touch have no wall between them, and where both end the first part in the file gives "
        "material and texture. A part that is a plane is the half-space below it (y < 0 in its own "
        "coordinates), and a quadric is solid where its formula is negative. Texture coordinates are the "
        "part's own.",
        {number(
             "blend", Nothing{}, "units of f",
             "The parts flow into each other where their formulas differ by less than this: instead of "
             "min(a, b), min(a, b) - k/4 (1 - min(|a - b|/k, 1))² (the quadratic polynomial smooth "
             "minimum, I. Quilez, https://iquilezles.org/articles/smin), part after part in the order of the "
             "file. Parts are `implicit`, or a sphere, box, cylinder, torus, plane or quadric (taken as "
             "their signed distance; the quadric as its formula). The material is that of "
             "the part whose formula is least.",
             above(0)),
         points("bounds", 2, "length",
                "Of a blend, as an implicit surface's. Without it they are proved, or else are those of its "
                "parts together, where those are written."),
         unresolved("Of a blend, as an implicit surface's. Without a blend, each formula has its own.")});
  solid("object.intersection",
        "What all parts have in common. Solids that only touch have nothing in common.", {});
  solid("object.difference",
        "The first part without all others, which leave walls with their own materials. A part that ends "
        "flush with the first leaves no skin.",
        {});
  return tables;
}

}  // namespace

std::vector<KeyTable> matter_tables() {
  std::vector<KeyTable> tables{frame(), material(), glass(), checker(), spectrum(), lines(), object()};
  for (KeyTable& shape : shapes()) tables.push_back(std::move(shape));
  tables.push_back(part());
  tables.push_back(repeat());
  set_clocks(tables);
  return tables;
}

}  // namespace backlight::key_builders
