// The keys that say what picture is made: docs/scene-reference.md is made from this text.
#include "key_builders.h"

namespace backlight::key_builders {
namespace {

KeyTable top() {
  return {
      "",
      "the top of the file",
      "One scene. Lengths are in scene units, times in seconds of the scene, and `c` ties the two.",
      {number("c", 1.0, "length/time", "The speed of light.", above(0)),
       structured(
           "include", {{ValueKind::paths}},
           "Files whose `params`, frames, materials, lights and objects are merged into this one, before "
           "its own. Their other tables are ignored, with a warning. Paths are relative to the including "
           "file. A parameter of the including file replaces one of the same name in an included file. A "
           "file that is reached twice is read once."),
       structured("params", {{ValueKind::parameters, 0, "params"}}, "Numbers with names."),
       structured("animation", {{ValueKind::table, 0, "animation"}}, "How frame numbers become times."),
       structured("film", {{ValueKind::table, 0, "film"}}, "The image's size and channels."),
       structured("camera", {{ValueKind::table, 0, "camera"}, {ValueKind::tables, 0, "camera"}},
                  "Who looks, from where, and when. A scene to be rendered has at least one."),
       structured("frame", {{ValueKind::named_tables, 0, "frame"}}, "Rest frames."),
       structured("material", {{ValueKind::named_tables, 0, "material"}}, "Materials."),
       structured("light", {{ValueKind::tables, 0, "light"}}, "Lights."),
       structured("object", {{ValueKind::tables, 0, "object"}}, "Objects."),
       structured("background", {{ValueKind::table, 0, "background"}}, "What is at infinity."),
       structured("effects", {{ValueKind::table, 0, "effects"}}, "Which relativistic effects are shown.")},
      ""};
}

KeyTable parameters() {
  return {
      "params",
      "[params]",
      "Numbers with names of your own, usable in every expression. A parameter may use `t`, `frame`, "
      "`image_time` and other parameters, in any order, but not itself. One that uses `t` is a formula: its "
      "`t` is that of the place where the parameter is used.",
      {},
      ""};
}

KeyTable animation() {
  return {
      "animation",
      "[animation]",
      "Frame number n is the image at the scene time t = (n - 1)/fps. Without this table t = 0.",
      {number("fps", 25.0, "1/s",
              "Frames a second of scene time. Does not depend on `t`, `image_time` or `frame`.", above(0)),
       numbers("frames", 2, std::vector<double>{1, 1}, "",
               "The first and the last frame number. Do not depend on `t`, `image_time` or `frame`.",
               whole(-1e6, 1e6))},
      ""};
}

KeyTable film() {
  return {
      "film",
      "[film]",
      "The image: its size, its accuracy and its channels.",
      {numbers("resolution", 2, std::vector<double>{720, 526}, "pixels", "Width and height.",
               whole(1, 65536)),
       number("samples", 1.0, "", "Samples a pixel; 1 is exactly the pixel's centre.", whole(1, 1048576)),
       number(
           "tolerance", Nothing{}, "",
           "The root mean square error of the image, 1 being the step from black to white on the screen (a "
           "step of "
           "an "
           "8-bit picture is 0.004): samples and wavelengths are then chosen to meet it, where `samples` and "
           "`wavelengths` do not give their number.",
           {.least = 1e-4, .greatest = 1}),
       number(
           "wavelengths", Nothing{}, "",
           "How many wavelengths of a reflectance made from red, green and blue are known where colours "
           "shift. "
           "Without it 56, or what `tolerance` needs. Saturated colors have 236 at least. Lights, tables and "
           "lines do not depend on it: they are summed whole.",
           whole(4, 1024)),
       number("exposure", 1.0, "",
              "Multiplies every film value. Of light with `absolute = true` it is the film value of 1 cd/m²: "
              "6e-10 shows the disc of the sun as about 1, 3e-5 a white wall in the sun. May depend on `t`.",
              at_least(0)),
       number("bounces", 8.0, "",
              "How many mirrors and surfaces of glass a ray is followed through, one after the other, before "
              "it ends "
              "black (which is counted, and warned of).",
              whole(0, 1000)),
       number("seed", 0.0, "", "Another number gives other sample positions.", whole(0, 4294967295.0)),
       {"aovs",
        {{ValueKind::choices}},
        Nothing{},
        "",
        "Channels besides the colour, of the ray through the pixel's centre: light-travel distance (infinite "
        "where the ray meets nothing), Doppler factor, world time and own time of the emission, point and "
        "normal in the object's rest frame, the object's number in the file (0 where there is none: there, "
        "all that is of a surface is 0 too), 1 where a root is not resolved (`unresolved`, see the shape "
        "implicit), and the light: `light.N`, how many lights reach the point (its own one of them; -1 where "
        "there is no surface), and `light.Y`, the luminance it would have if no colour were shifted. "
        "`samples.N` is the number of samples that the pixel got. All of that is of the first surface; "
        "`mirror.Z`, `mirror.D`, `mirror.T` and `mirror.V` are the light-travel distance, Doppler factor, "
        "world "
        "time and object's number of what is seen in it or through it, where it is a mirror or glass. "
        "`lampTime` is a channel for "
        "each "
        "light, `lampTime.1` and so on in file order: the light's own time when it sent what lights the "
        "point (of an "
        "ambient one the surface's), and -infinity where it does not light it.",
        {},
        {"Z", "doppler", "emissionTime", "properTime", "P", "N", "objectId", "unresolved", "light", "samples",
         "mirror", "lampTime"}}},
      ""};
}

KeyTable camera() {
  KeyTable table{
      "camera",
      "[camera] or [[camera]]",
      "An observer with a pinhole camera. Its axes are those of its rest frame, which are the world's "
      "carried by the "
      "pure boost. With `frame`, `position` and `time` are that frame's coordinates. With a velocity, its "
      "world line "
      "passes `position` at world time 0, which is its own time 0.\n\n"
      "Without a velocity, a `position` that depends on `t` is a path: the camera is where the formula says "
      "at "
      "`time` (of the world, or of its `frame`), and its velocity is the path's, dposition/dtime, by exact "
      "differentiation. The film is then what one moving observer sees, with aberration, colour and "
      "brightness "
      "of its speed. Write `velocity = [0, 0, 0]` for a camera that is put somewhere else for each image and "
      "is "
      "at rest in all of them. With `rocket` it accelerates.",
      {text("name",
            "Needed to choose among several cameras with `--camera`; the first one is used otherwise."),
       numbers("position", 3, std::vector<double>{0, 0, 0}, "length",
               "Where it is at its own time 0; or, as formulas of `t` without a velocity, its path."),
       numbers("look_at", 3, Nothing{}, "length",
               "Looks along `look_at - position`, read as a direction in the camera's frame."),
       numbers("direction", 3, std::vector<double>{0, 0, 1}, "",
               "Looks along this direction of its own frame; of any length but zero. Instead of `look_at`."),
       numbers("up", 3, std::vector<double>{0, 1, 0}, "",
               "The image's upward direction, as far as it is perpendicular to the looking direction; not "
               "parallel "
               "to that."),
       number(
           "time", std::string("t"), "s",
           "The camera's own (proper) time of the exposure, with a velocity or a `rocket`; else the time of "
           "its frame."),
       structured(
           "rocket", {{ValueKind::table, 0, "rocket"}},
           "A flight at constant proper acceleration, which begins at its own time 0 at `position`, at "
           "rest in its `frame` or with its velocity."),
       text("aboard",
            "The name of an object that it rides with: `position`, `look_at`, `direction` and `up` are then "
            "in the object's own coordinates, and turn with it; `time` is the camera's own time, which is 0 "
            "with the time of the object's frame."),
       number("world_time", Nothing{}, "s", "The world's time of the exposure, instead of `time`."),
       choice("projection", std::string("perspective"),
              {"perspective", "equirectangular", "mercator", "fisheye", "cubemap"},
              "`perspective`: straight lines stay straight. `equirectangular`: all directions, longitude "
              "across and "
              "latitude down. `mercator`: all longitudes, angles kept. `fisheye`: equidistant, the distance "
              "from the "
              "middle is the angle. `cubemap`: six faces of a cube, three across and two down, right, left, "
              "up; down, "
              "front, back; the resolution is 3:2."),
       number("fov", 60.0, "degrees",
              "Full horizontal angle of a perspective (less than 180) or a fisheye; the other projections "
              "show all "
              "directions and ignore it.",
              {.least = 0, .greatest = 360, .above_least = true}),
       structured(
           "screen", {{ValueKind::table, 0, "camera.screen"}},
           "A wall or a screen, by three corners: the image is what the eye at `position` sees through it, "
           "wherever that is. In place of `look_at`, `direction`, `up` and `fov`."),
       structured("stereo", {{ValueKind::table, 0, "camera.stereo"}},
                  "Two eyes: left and right image in one file.")},
      ""};
  add_motion_or_frame(table.keys);
  return table;
}

Key made_anew(Key key) {
  key.clock = Clock::anew;
  key.physically = "a flight whose thrust changes is a path: position as a formula of t";
  return key;
}

KeyTable rocket() {
  return {
      "rocket",
      "rocket = { ... }",
      "A flight at constant proper acceleration (hyperbolic motion), of a camera, an object or a light: "
      "those "
      "aboard weigh the same all the time. It is at rest at its own time 0, and decelerates before that. An "
      "object keeps its shape for those aboard (Born's rigid motion), so that its rear accelerates more than "
      "its front: `acceleration` is that of the point at `position`.",
      {made_anew(number("acceleration", Required{}, "length/time²", "What an accelerometer aboard shows.",
                        above(0))),
       made_anew(
           numbers("along", 3, Required{}, "",
                   "The direction of the thrust, in the axes of the frame in which the flight begins; of any "
                   "length but zero."))},
      ""};
}

KeyTable screen() {
  return {"camera.screen",
          "[camera] screen = { ... }",
          "Three corners of a rectangle, as the eye sees them, in the coordinates of `position`; corner - "
          "position is "
          "read in the camera's frame, as `look_at` is. An eye before each wall of a room makes one picture "
          "of the "
          "walls, with no seam between them.",
          {numbers("lower_left", 3, Required{}, "length",
                   "The corner of the screen that is at the lower left of the picture."),
           numbers("lower_right", 3, Required{}, "length", "That at the lower right."),
           numbers("upper_left", 3, Required{}, "length",
                   "That at the upper left; the fourth is where it completes the rectangle.")},
          ""};
}

KeyTable stereo() {
  return {"camera.stereo",
          "[camera] stereo = { ... }",
          "Two eyes, to the left and to the right of the camera's position, in its rest frame.",
          {number("separation", 0.065, "length", "The distance between the eyes.", above(0))},
          ""};
}

}  // namespace

std::vector<KeyTable> picture_tables() {
  return {top(), parameters(), animation(), film(), camera(), rocket(), screen(), stereo()};
}

}  // namespace backlight::key_builders
