#include "pixel_probe.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <sstream>

#include "backlight/camera/projection.h"

namespace backlight {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;

std::optional<float> value_of(const PixelFacts& facts, std::string_view channel) {
  const auto found = std::ranges::find(facts.channels, channel, &std::pair<std::string, float>::first);
  if (found == facts.channels.end()) return std::nullopt;
  return found->second;
}

// Three channels, of a colour or a vector.
std::optional<Vec3> three_of(const PixelFacts& facts, const std::array<const char*, 3>& names) {
  Vec3 result{0.0};
  for (int i = 0; i < 3; ++i) {
    const auto value = value_of(facts, names[static_cast<std::size_t>(i)]);
    if (!value) return std::nullopt;
    result[i] = double(*value);
  }
  return result;
}

// The camera's geometry, as the header of an image by Backlight tells it.
std::optional<Lens> lens_of(const ExrInfo& info) {
  const auto* name = info.header.find<std::string>("backlight/projection");
  const auto projection = name != nullptr ? projection_named(*name) : std::nullopt;
  if (!projection || !info.header.world_to_camera) return std::nullopt;
  Lens lens;
  lens.projection = *projection;
  lens.width = info.layout.display.width();
  lens.height = info.layout.display.height();
  if (const auto* fov = info.header.find<double>("backlight/fov")) lens.fov = *fov / degrees;
  if (const auto* screen = info.header.find<std::string>("backlight/screen")) {
    std::istringstream numbers(*screen);
    ScreenFilm film;
    if (!(numbers >> film.foot.x >> film.foot.y >> film.step_x >> film.step_y)) return std::nullopt;
    lens.screen = film;
  }
  const std::array<float, 16>& m = *info.header.world_to_camera;
  const auto column = [&m](std::size_t i) {
    return glm::normalize(Vec3{double(m[i]), double(m[4 + i]), double(m[8 + i])});
  };
  lens.right = column(0);
  lens.up = column(1);
  lens.forward = -column(2);
  return lens;
}

// By the tangent: exact where the cosine is flat too.
double angle_between(const Vec3& a, const Vec3& b) {
  return degrees * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

std::optional<double> angle_from_motion(const Vec3& direction, const Vec3& velocity) {
  if (velocity == Vec3{0.0}) return std::nullopt;
  return angle_between(direction, velocity);
}

// Of runs "first last x y z", the velocity of an object; nothing of matter in motion, which no run has.
std::optional<Vec3> velocity_of(const std::vector<std::string>& runs, int object) {
  for (const std::string& run : runs) {
    std::istringstream words(run);
    int first = 0;
    int last = 0;
    Vec3 v{0.0};
    if (words >> first >> last >> v.x >> v.y >> v.z && first <= object && object <= last) return v;
  }
  return std::nullopt;
}

void add_channels(PixelFacts& facts) {
  facts.colour = three_of(facts, {"R", "G", "B"});
  facts.alpha = value_of(facts, "A");
  facts.distance = value_of(facts, "Z");
  facts.doppler = value_of(facts, "doppler.D");
  facts.emission_time = value_of(facts, "emissionTime.T");
  facts.proper_time = value_of(facts, "properTime.T");
  facts.position = three_of(facts, {"P.X", "P.Y", "P.Z"});
  facts.normal = three_of(facts, {"N.X", "N.Y", "N.Z"});
  if (const auto id = value_of(facts, "objectId.V")) facts.object_id = static_cast<int>(std::lround(*id));
  const std::array<std::pair<const char*, bool>, 7> asked{{{"objectId", facts.object_id.has_value()},
                                                           {"doppler", facts.doppler.has_value()},
                                                           {"emissionTime", facts.emission_time.has_value()},
                                                           {"properTime", facts.proper_time.has_value()},
                                                           {"Z", facts.distance.has_value()},
                                                           {"P", facts.position.has_value()},
                                                           {"N", facts.normal.has_value()}}};
  for (const auto& [aov, there] : asked) {
    if (!there) facts.missing.emplace_back(aov);
  }
}

// Of what a ray that meets nothing leaves at 0.
void forget_surface(PixelFacts& facts) {
  facts.emission_time = facts.proper_time = std::nullopt;
  facts.position = facts.normal = std::nullopt;
}

bool tells_of_no_delay(const std::string& effects) {
  return effects.find("light_delay = false") != std::string::npos;
}

// In the camera's frame light has travelled for as long as its way is; without light delay all is seen as it
// is there now. Where regions of the image have different delays it is not told.
void add_camera_time(const ExrHeader& header, PixelFacts& facts) {
  const auto* time = header.find<double>("backlight/cameraTime");
  const auto* effects = header.find<std::string>("backlight/effects");
  if (!facts.distance || time == nullptr || effects == nullptr) return;
  const bool no_delay = tells_of_no_delay(*effects);
  if (const auto* regions = header.find<std::vector<std::string>>("backlight/effectsRegions")) {
    for (const std::string& region : *regions) {
      if (tells_of_no_delay(region) != no_delay) return;
    }
  }
  facts.camera_time = *time - (no_delay ? 0.0 : double(*facts.distance) / facts.c);
}

}  // namespace

Result<PixelProbe> PixelProbe::open(const std::filesystem::path& file, std::size_t view) {
  auto reader = ExrReader::open(file);
  if (!reader.ok()) return reader.failure();
  if (view > 0 && reader.value().info().layout.views.size() <= view)
    return Failure{file.string() + " has one view only, no right eye"};
  return PixelProbe(std::move(reader).value(), view);
}

std::string PixelProbe::absence(const PixelPlace& place) const {
  const ImageLayout& layout = reader_.info().layout;
  const auto range = [](const PixelBox& box) {
    return "x from " + std::to_string(box.x0) + " to " + std::to_string(box.x1 - 1) + ", y from " +
           std::to_string(box.y0) + " to " + std::to_string(box.y1 - 1);
  };
  if (layout.data.contains(place.x, place.y)) return {};
  if (layout.display.contains(place.x, place.y))
    return "is not in this crop, which has " + range(layout.data);
  return "is outside of the image, which has " + range(layout.data);
}

Result<std::optional<PixelFacts>> PixelProbe::facts(const PixelPlace& place) {
  const ImageLayout& layout = reader_.info().layout;
  const auto width = static_cast<std::size_t>(layout.data.width());
  std::vector<std::vector<float>> row(layout.channels.size(), std::vector<float>(width));
  const std::vector<std::span<float>> planes(row.begin(), row.end());
  if (const auto read = reader_.read_rows(place.y, 1, planes); !read.ok()) return read.failure();
  PixelFacts facts;
  const auto column = static_cast<std::size_t>(place.x - layout.data.x0);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (auto name = plain_name(layout.channels[i].name, layout.views, view_))
      facts.channels.emplace_back(*name, row[i][column]);
  }
  if (value_of(facts, "rendered.V") == 0.0F) return std::optional<PixelFacts>{};
  add_channels(facts);
  add_object(facts);
  add_angles(place, facts);
  return std::optional{std::move(facts)};
}

void PixelProbe::add_object(PixelFacts& facts) const {
  const ExrHeader& header = reader_.info().header;
  if (const auto* c = header.find<double>("backlight/c")) facts.c = *c;
  facts.is_sky = facts.object_id ? *facts.object_id == 0 : facts.distance && std::isinf(*facts.distance);
  if (facts.is_sky) return forget_surface(facts);
  add_camera_time(header, facts);
  if (!facts.object_id || *facts.object_id < 1) return;
  const auto* names = header.find<std::vector<std::string>>("backlight/objects");
  const auto index = static_cast<std::size_t>(*facts.object_id - 1);
  if (names != nullptr && index < names->size()) facts.object = (*names)[index];
  if (const auto* runs = header.find<std::vector<std::string>>("backlight/objectVelocities")) {
    facts.object_velocity = velocity_of(*runs, *facts.object_id);
    facts.matter_moves = !facts.object_velocity;
  }
}

void PixelProbe::add_angles(const PixelPlace& place, PixelFacts& facts) const {
  const auto lens = lens_of(reader_.info());
  if (!lens) return;
  const auto direction = direction_at(*lens, {place.x + 0.5, place.y + 0.5});
  if (!direction) return;
  facts.from_axis = angle_between(*direction, lens->forward);
  if (const auto* velocity = reader_.info().header.find<Vec3>("backlight/cameraVelocity"))
    facts.from_camera_motion = angle_from_motion(*direction, *velocity);
  if (facts.object_velocity) facts.from_object_motion = angle_from_motion(*direction, *facts.object_velocity);
}

}  // namespace backlight
