#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "aboard.h"
#include "camera_motion.h"
#include "compile_parts.h"
#include "words.h"

namespace backlight {
namespace {

const Node* among(ImageValues& values, const ImageRequest& request, const NodeArray& cameras) {
  const std::string& wanted = request.camera;
  std::vector<std::string> names;
  for (const Node& node : cameras) {
    const Entry* name = find(node, "name");
    if (name != nullptr && name->node.text() != nullptr) names.push_back(*name->node.text());
    if (wanted.empty() || (name != nullptr && name->node.text() != nullptr && *name->node.text() == wanted)) {
      return &node;
    }
  }
  values.diagnostics.error({}, "there is no camera '" + wanted + "'",
                           names.empty() ? std::string() : "the cameras are " + listed(names, "and"));
  return nullptr;
}

// The exposure's event, and the camera's own time of it. `frame` is its rest frame, `x` where it rests there.
void expose(const TableView& table, const InertialFrame& frame, const Vec3& x, Scene& scene) {
  const Extended c(scene.c);
  const ExtendedVec3 at(x);
  scene.camera.celerity = frame.celerity;
  Extended own_time = c * Extended(table.number("time"));
  const bool by_world_time =
      table.one_of({"time", "world_time"}) == "world_time" && table.has_valid("world_time");
  if (by_world_time) {
    // t_W = t_origin + γ t' + u·x' solved for t'.
    const Extended world_time = c * Extended(table.number("world_time"));
    own_time = (world_time - frame.origin.t - dot(frame.celerity, at)) / lorentz_factor(frame.celerity);
    scene.camera.event = to_world(frame, {own_time, at});
    scene.camera.event.t = world_time;
  } else {
    scene.camera.event = to_world(frame, {own_time, at});
  }
  scene.camera.proper_time = double(own_time);
}

InertialFrame rest_frame(Compilation& c, const TableView& table, Vec3& position) {
  const ExtendedVec3 celerity = read_celerity(table, c.scene.c);
  if (!has_motion(table)) return c.frames.named(table.text("frame"));
  if (table.has("frame")) table.error("frame", "a camera has a frame or a velocity of its own, not both");
  if (celerity == ExtendedVec3{}) return {};
  const InertialFrame own{celerity, {Extended(0.0), ExtendedVec3(position)}};
  position = Vec3{0.0};
  return own;
}

// `position` is as written, and `sound` if nothing was wrong with it: a direction made of a wrong number is
// not complained about besides.
void point_lens(const TableView& table, const Vec3& position, bool sound, Lens& lens) {
  const std::string_view given = table.one_of({"look_at", "direction"});
  const std::size_t errors = table.values().diagnostics.error_count();
  const Vec3 direction = given == "look_at" ? table.vector("look_at") - position : table.vector("direction");
  const Vec3 up = table.vector("up");
  if (aim(lens, direction, up) || !sound || table.values().diagnostics.error_count() > errors) return;
  for (const std::string_view key : {"position", "look_at", "direction", "up"}) {
    if (!table.is_sound(key)) return;
  }
  if (direction == Vec3{0.0}) {
    const bool by_point = given == "look_at";
    return table.error(by_point ? "look_at" : "direction", by_point
                                                               ? "'look_at' is where the camera itself is"
                                                               : "'direction' is zero: it points nowhere");
  }
  if (up == Vec3{0.0}) return table.error("up", "'up' is zero: it points nowhere");
  table.error(table.has("up") ? "up" : given, "the camera looks along 'up', which must point elsewhere",
              "add another, such as up = [0, 0, 1]");
}

// Reports what is wrong with a screen, seen from `position`; else points the lens at its plane.
void point_at_screen(const TableView& table, const Vec3& position, const FilmSettings& film, Lens& lens) {
  const TableView screen = table.table("screen", "camera.screen");
  const std::size_t errors = table.values().diagnostics.error_count();
  for (const std::string_view key : {"look_at", "direction", "up", "fov", "stereo"}) {
    if (table.has(key)) {
      table.error(key, "a camera with a 'screen' has no '" + std::string(key) + "'",
                  key == "stereo" ? "give each eye a camera of its own, with the same screen"
                                  : "the screen and 'position' say what it shows");
    }
  }
  if (table.text("projection") != "perspective")
    table.error("projection", "a 'screen' needs the projection perspective");
  const Vec3 corner = screen.vector("lower_left") - position;
  const Vec3 across = screen.vector("lower_right") - position - corner;
  const Vec3 upward = screen.vector("upper_left") - position - corner;
  if (table.values().diagnostics.error_count() > errors || !table.is_sound("position")) return;
  const double width = glm::length(across);
  const double height = glm::length(upward);
  if (!(width > 0.0 && height > 0.0))
    return table.error("screen", "the screen has no area: two corners are the same");
  if (!(std::abs(glm::dot(across, upward)) <= 1e-6 * width * height))
    return table.error("screen",
                       "the screen is no rectangle: its edges from 'lower_left' are not perpendicular");
  if (!aim(lens, glm::cross(upward, across), upward)) return table.error("screen", "the screen has no area");
  const double distance = glm::dot(corner, lens.forward);
  if (!(std::abs(distance) > 1e-9 * (glm::length(corner) + width)))
    return table.error("screen", "the camera is in the plane of its screen");
  if (distance < 0.0) {
    return table.error("screen", "the camera sees the screen from behind",
                       "its corners are named as the camera sees them: exchange the left and the right ones");
  }
  const double pixel_width = width / film.width;
  const double pixel_height = height / film.height;
  lens.screen = {
      {-glm::dot(corner, lens.right) / pixel_width, film.height + glm::dot(corner, lens.up) / pixel_height},
      pixel_width / distance,
      pixel_height / distance};
}

void read_lens(const TableView& table, const FilmSettings& film, Lens& lens) {
  lens.projection = projection_named(table.text("projection")).value_or(Projection::perspective);
  lens.width = film.width;
  lens.height = film.height;
  if (lens.projection == Projection::cubemap && !fits_cubemap(film.width, film.height)) {
    const int edge = std::max(1, (film.width + 1) / 3);
    table.error("projection",
                "a cubemap's six faces need a resolution of 3:2, a multiple of 3 wide, not " +
                    std::to_string(film.width) + "x" + std::to_string(film.height),
                "such as " + std::to_string(3 * edge) + "x" + std::to_string(2 * edge));
  }
  const double degrees = table.number("fov");
  if (lens.projection == Projection::perspective && degrees >= 180.0) {
    table.error("fov", "a perspective's 'fov' is " + number_text(degrees) + ", but must be less than 180",
                "projection = \"fisheye\" shows up to 360 degrees");
  }
  lens.fov = degrees * (std::numbers::pi / 180.0);
}

}  // namespace

const Node* find_camera(ImageValues& values, const ImageRequest& request) {
  const Entry* entry = find(values.description.root, "camera");
  if (entry == nullptr) {
    SourceSpan whole_file;
    whole_file.source = values.description.sources.front();
    values.diagnostics.error(whole_file, "the scene has no [camera]");
    return nullptr;
  }
  if (const NodeArray* cameras = entry->node.array()) {
    if (!cameras->empty()) return among(values, request, *cameras);
    values.error(entry->place, "the scene has no [camera]");
    return nullptr;
  }
  if (entry->node.table() == nullptr) return nullptr;  // reported before
  const Entry* name = find(entry->node, "name");
  const bool other = name == nullptr || name->node.text() == nullptr || *name->node.text() != request.camera;
  if (!request.camera.empty() && other) {
    values.diagnostics.error({}, "there is no camera '" + request.camera + "'",
                             "the scene has one camera only");
  }
  return &entry->node;
}

void compile_camera(Compilation& c) {
  const Node* node = find_camera(c.values, c.request);
  if (node == nullptr) return;
  const TableView table(c.values, node, *find_table("camera"));
  const std::size_t errors = c.values.diagnostics.error_count();
  c.scene.camera.name = table.text("name");
  Vec3 position = table.vector("position");
  const bool has_screen = table.has_valid("screen");
  if (has_screen) point_at_screen(table, position, c.scene.film, c.scene.camera.lens);
  if (!has_screen)
    point_lens(table, position, c.values.diagnostics.error_count() == errors, c.scene.camera.lens);
  if (!ride(c, table) && !fly(c, table) && !follow_path(c, table)) {
    const InertialFrame frame = rest_frame(c, table, position);
    expose(table, frame, position, c.scene);
  }
  if (!can_be_computed_with({c.scene.camera.celerity, c.scene.camera.event})) {
    c.values.error(table.place(),
                   "the camera is too far, too late or too fast: in the world, its place, its time "
                   "and its celerity must be at most " +
                       number_text(greatest_composed) + " in size");
  }
  read_lens(table, c.scene.film, c.scene.camera.lens);
  if (table.has_valid("stereo")) {
    const Projection projection = c.scene.camera.lens.projection;
    if (projection == Projection::mercator || projection == Projection::cubemap)
      table.error("stereo", "two eyes need a perspective, a fisheye or an equirectangular projection");
    c.scene.camera.stereo = Stereo{table.table("stereo", "camera.stereo").number("separation")};
  }
}

}  // namespace backlight
