#include <numbers>

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

void read_lens(const TableView& table, const FilmSettings& film, Lens& lens) {
  lens.projection = projection_named(table.text("projection")).value_or(Projection::perspective);
  lens.width = film.width;
  lens.height = film.height;
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
    if (projection == Projection::mercator || projection == Projection::fisheye) {
      table.error("stereo", "two eyes need a perspective or an equirectangular projection");
    }
    c.scene.camera.stereo = Stereo{table.table("stereo", "camera.stereo").number("separation")};
  }
}

}  // namespace backlight
