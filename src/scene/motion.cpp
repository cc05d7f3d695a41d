#include "motion.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace backlight {
namespace {

const std::vector<std::string_view> motion_keys{"velocity", "beta", "gamma", "celerity", "rapidity"};

Extended magnitude(const ExtendedVec3& v) {
  return sqrt(dot(v, v));
}

// u = b/√(1 - b²). The speed is shown in the units in which it was written.
ExtendedVec3 celerity_of_velocity(const TableView& table, std::string_view key, double c) {
  const ExtendedVec3 written(table.vector(key));
  const Extended unit = key == "velocity" ? Extended(c) : Extended(1.0);
  const Extended speed2 = dot(written, written);
  const Extended rest = unit * unit - speed2;
  if (rest.hi > 0.0) return (Extended(1.0) / sqrt(rest)) * written;
  const Vec3 v = written.rounded();
  const std::string speed = number_text(std::hypot(v.x, v.y, v.z));
  const std::string name(key);
  const bool equal = rest.hi == 0.0 && rest.lo == 0.0;
  std::string message = "|" + name + "| = " + speed + (equal ? " is" : " exceeds") + " the speed of light";
  if (key == "velocity") message += ", c = " + number_text(c);
  constexpr double no_share_of_c = 10.0;
  const bool other_units = key == "velocity" && c == 1.0 && std::hypot(v.x, v.y, v.z) > no_share_of_c;
  table.error(key, message,
              other_units
                  ? "velocities are in units in which the speed of light is the scene's c: write "
                    "c = 299792458 for metres and seconds"
                  : "nothing reaches the speed of light; for very fast things write gamma = ... with along");
  return {};
}

// A celerity's size from gamma, celerity or rapidity.
Extended size_of(const TableView& table, std::string_view key) {
  const auto value = table.optional_number(key);
  if (!value) return {};
  if (key == "celerity") return *value;
  if (key == "rapidity") return sinh(Extended(*value));
  const Extended gamma(*value);
  return sqrt((gamma - 1.0) * (gamma + 1.0));
}

}  // namespace

bool can_be_computed_with(const InertialFrame& frame) {
  const auto is_small = [](const Extended& number) { return std::abs(double(number)) <= greatest_composed; };
  bool small = is_small(frame.origin.t);
  for (int i = 0; i < 3; ++i) small = small && is_small(frame.origin.x[i]) && is_small(frame.celerity[i]);
  return small;
}

bool has_motion(const TableView& table) {
  for (const std::string_view key : motion_keys) {
    if (table.has(key)) return true;
  }
  return false;
}

ExtendedVec3 read_celerity(const TableView& table, double c) {
  const std::string_view key = table.one_of(motion_keys);
  const bool needs_along = key == "gamma" || key == "celerity" || key == "rapidity";
  if (!needs_along) {
    if (table.has("along")) {
      table.error("along", "'along' goes with gamma, celerity or rapidity, and none of them is given");
    }
    return key.empty() ? ExtendedVec3{} : celerity_of_velocity(table, key, c);
  }
  const Extended size = size_of(table, key);
  if (!table.has("along")) {
    table.error(key, "'" + std::string(key) + "' needs a direction", "add along = [x, y, z]");
    return {};
  }
  if (!table.has_valid("along")) return {};
  const ExtendedVec3 along(of_size_one(table.vector("along")));
  if (along == ExtendedVec3{}) {
    table.error("along", "'along' is zero: it has no direction");
    return {};
  }
  if (size.hi == 0.0) return {};
  return (size / magnitude(along)) * along;
}

std::size_t HashOfFrame::operator()(const InertialFrame& frame) const {
  std::size_t seed = 0;
  const auto mix = [&seed](Extended value) {
    for (const double part : {value.hi, value.lo}) {
      seed ^= std::hash<double>{}(part) + 0x9e3779b97f4a7c15ULL + (seed << 6U) + (seed >> 2U);
    }
  };
  for (int i = 0; i < 3; ++i) mix(frame.celerity[i]);
  for (int i = 0; i < 3; ++i) mix(frame.origin.x[i]);
  mix(frame.origin.t);
  return seed;
}

Frames::Frames(ImageValues& values, double c, std::vector<SceneFrame>& scene_frames)
    : values_(values), c_(c), scene_frames_(scene_frames) {
  named_.emplace("world", InertialFrame{});
  index_of(InertialFrame{}, "world");
  const Entry* frames = find(values.description.root, "frame");
  if (frames == nullptr || frames->node.table() == nullptr) return;
  std::unordered_map<std::string, const Node*> written;
  for (const Entry& entry : *frames->node.table()) written.emplace(entry.name, &entry.node);
  for (const Entry& entry : *frames->node.table()) {
    // Outermost first. The reader has seen to it that `within` goes round in no circle.
    std::vector<std::pair<std::string, const Node*>> way;
    std::string name = entry.name;
    for (auto next = written.find(name); next != written.end() && named_.count(name) == 0;
         next = written.find(name)) {
      way.emplace_back(name, next->second);
      name = TableView(values_, next->second, *find_table("frame")).text("within");
    }
    for (auto step = way.rbegin(); step != way.rend(); ++step) define(step->first, *step->second);
  }
}

void Frames::define(const std::string& name, const Node& written) {
  const TableView table(values_, &written, *find_table("frame"));
  InertialFrame frame;
  frame.celerity = read_celerity(table, c_);
  frame.origin.x = ExtendedVec3(table.vector("origin"));
  frame.origin.t = Extended(c_) * Extended(table.number("origin_time"));
  const std::string outer = table.text("within");
  if (outer != "world") frame = within(named(outer), frame);
  if (!can_be_computed_with(frame)) {
    values_.error(table.place(), "the frame '" + name +
                                     "' is too far or too fast in the world: there, its origin and its "
                                     "celerity must be at most " +
                                     number_text(greatest_composed) + " in size");
    frame = {};
  }
  named_.emplace(name, frame);
}

const InertialFrame& Frames::named(const std::string& name) const {
  const auto found = named_.find(name);
  return found != named_.end() ? found->second : named_.at("world");
}

int Frames::index_of(const InertialFrame& frame, const std::string& name) {
  const auto [there, added] = indices_.emplace(frame, static_cast<int>(scene_frames_.size()));
  if (added) apart(frame, name);
  return there->second;
}

int Frames::apart(const InertialFrame& frame, const std::string& name) {
  scene_frames_.emplace_back();
  scene_frames_.back().name = name;
  scene_frames_.back().motion = frame;
  return static_cast<int>(scene_frames_.size()) - 1;
}

RestPlace Frames::rest_of(const TableView& thing, const Vec3& position) {
  if (!has_motion(thing)) {
    check_at_rest(thing);
    const std::string name = thing.text("frame");
    return {index_of(named(name), name), position};
  }
  const ExtendedVec3 celerity = own_celerity(thing);
  if (celerity == ExtendedVec3{}) return {0, position};
  return {index_of({celerity, {Extended(0.0), ExtendedVec3(position)}}, ""), Vec3{0.0}};
}

std::optional<InertialFrame> Frames::own_motion(const TableView& thing) {
  const ExtendedVec3 celerity = own_celerity(thing);
  if (celerity == ExtendedVec3{}) return std::nullopt;
  return InertialFrame{celerity, {Extended(0.0), ExtendedVec3(thing.vector("position"))}};
}

void Frames::check_at_rest(const TableView& thing) {
  if (thing.has("along")) read_celerity(thing, c_);
}

ExtendedVec3 Frames::own_celerity(const TableView& thing) {
  if (thing.has("frame")) {
    thing.error("frame", "a thing has a frame or a velocity of its own, not both",
                "remove 'frame', or define a [frame.NAME] with this velocity within it");
  }
  return read_celerity(thing, c_);
}

}  // namespace backlight
