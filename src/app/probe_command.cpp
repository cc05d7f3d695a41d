#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include "backlight/base/json_text.h"
#include "backlight/colour/rgb.h"
#include "commands.h"
#include "exit_codes.h"
#include "messages.h"
#include "pixel_probe.h"

namespace backlight {
namespace {

// Channels are floats: no more digits than they have.
std::string shortest(float value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string rounded(double value, int digits) {
  std::ostringstream text;
  text << std::setprecision(digits) << value;
  return text.str();
}

std::string vector_text(const Vec3& v) {
  const Vec3 shown = v + 0.0;  // of zeros the positive one
  return shortest(float(shown.x)) + " " + shortest(float(shown.y)) + " " + shortest(float(shown.z));
}

void print_row(const char* name, const std::string& value) {
  std::cout << "  " << std::left << std::setw(26) << name << ' ' << value << '\n';
}

// Channels that have a row of their own.
bool is_told_in_words(const std::string& name) {
  constexpr std::array told{"R",   "G",   "B",   "A",   "Z",   "doppler.D", "emissionTime.T", "properTime.T",
                            "P.X", "P.Y", "P.Z", "N.X", "N.Y", "N.Z",       "objectId.V",     "rendered.V"};
  return std::ranges::find(told, name) != told.end();
}

std::string object_text(const PixelFacts& facts) {
  if (facts.is_sky) return "none: the ray meets no surface";
  if (!facts.object_id) return {};
  const std::string number = "object " + std::to_string(*facts.object_id) + " of the scene";
  if (!facts.object) return number + " (the file does not tell its name)";
  return facts.object->empty() ? number + ", which has no name" : *facts.object + " (" + number + ")";
}

std::string shift_text(float doppler) {
  const std::string arrival = rounded(550.0 / double(doppler), 4) + " nm";
  if (doppler == 1.0F) return "no shift";
  return std::string(doppler > 1.0F ? "blueshift" : "redshift") + ": 550 nm arrive as " + arrival;
}

void print_angles(const PixelFacts& facts) {
  const auto angle = [](double degrees) { return rounded(degrees, 6) + " degrees"; };
  if (facts.from_axis) print_row("angle from view axis", angle(*facts.from_axis));
  if (facts.from_camera_motion) print_row("from camera's velocity", angle(*facts.from_camera_motion));
  if (facts.matter_moves) print_row("object's velocity", "not one: its matter turns or accelerates");
  if (!facts.object_velocity) return;
  const double speed = glm::length(*facts.object_velocity) / facts.c;
  if (facts.from_object_motion) {
    print_row("from object's velocity", angle(*facts.from_object_motion) + "; it moves at " +
                                            rounded(speed, 6) + " c against the camera");
  } else {
    print_row("object's velocity", "at rest against the camera");
  }
}

void print_text(const std::string& file, const PixelPlace& place, const PixelFacts& facts) {
  std::cout << file << ": pixel " << place.x << ',' << place.y << '\n';
  const auto number = [](const char* name, const std::optional<float>& value, const std::string& what) {
    if (value) print_row(name, shortest(*value) + what);
  };
  if (const std::string object = object_text(facts); !object.empty()) print_row("object", object);
  if (facts.colour) {
    print_row("colour (linear R G B)",
              vector_text(*facts.colour) + "; luminance " + rounded(luminance(LinearRgb(*facts.colour)), 6));
  }
  number("alpha", facts.alpha, "");
  if (facts.doppler)
    print_row("Doppler factor D", shortest(*facts.doppler) + "  " + shift_text(*facts.doppler));
  print_angles(facts);
  number("emission time", facts.emission_time, " s of the world");
  if (facts.camera_time)
    print_row("time in camera's frame", rounded(*facts.camera_time, 7) + " s by the camera's clock");
  number("own time", facts.proper_time, " s of the matter, when the light left it");
  number("distance", facts.distance, " that the light travelled, as the camera measures it");
  if (facts.position)
    print_row("P", vector_text(*facts.position) + "  in the coordinates of the object's frame");
  if (facts.normal) print_row("N", vector_text(*facts.normal) + "  in the axes of the object's frame");
  for (const auto& [name, value] : facts.channels) {
    if (!is_told_in_words(name)) print_row(name.c_str(), shortest(value));
  }
  if (facts.missing.empty()) return;
  std::string list;
  for (const std::string& aov : facts.missing) list += (list.empty() ? "" : ",") + aov;
  print_row("not in the file", list + "  (render with --aov " + list + ")");
}

std::string json_single(float value) {
  return std::isfinite(value) ? shortest(value) : "null";
}

std::string json_vector(const Vec3& v) {
  return "[" + json_single(float(v.x)) + "," + json_single(float(v.y)) + "," + json_single(float(v.z)) + "]";
}

void print_json(const std::string& file, const PixelPlace& place, const PixelFacts& facts) {
  std::string line = "{\"file\":" + json_quoted(file) + ",\"pixel\":[" + std::to_string(place.x) + "," +
                     std::to_string(place.y) + "]";
  const auto add = [&line](const char* name, const std::string& value) {
    line += std::string(",\"") + name + "\":" + value;
  };
  const auto channel = [&add](const char* name, const std::optional<float>& value) {
    add(name, value ? json_single(*value) : "null");
  };
  const auto number = [&add](const char* name, const std::optional<double>& value) {
    add(name, value ? json_number(*value) : "null");
  };
  const auto vector = [&add](const char* name, const std::optional<Vec3>& value) {
    add(name, value ? json_vector(*value) : "null");
  };
  add("object", facts.object ? json_quoted(*facts.object) : "null");
  add("objectId", facts.object_id ? std::to_string(*facts.object_id) : "null");
  vector("colour", facts.colour);
  channel("alpha", facts.alpha);
  channel("doppler", facts.doppler);
  number("angleFromViewAxis", facts.from_axis);
  number("angleFromCameraVelocity", facts.from_camera_motion);
  number("angleFromObjectVelocity", facts.from_object_motion);
  vector("objectVelocity", facts.object_velocity);
  channel("emissionTime", facts.emission_time);
  number("timeInCameraFrame", facts.camera_time);
  channel("properTime", facts.proper_time);
  channel("Z", facts.distance);
  vector("P", facts.position);
  vector("N", facts.normal);
  std::string channels;
  for (const auto& [name, value] : facts.channels) {
    channels += (channels.empty() ? "" : ",") + json_quoted(name) + ":" + json_single(value);
  }
  add("channels", "{" + channels + "}");
  std::string missing;
  for (const std::string& aov : facts.missing) missing += (missing.empty() ? "" : ",") + json_quoted(aov);
  add("missing", "[" + missing + "]");
  std::cout << line << "}\n";
}

}  // namespace

int run(const ProbeOptions& options) {
  const std::string file = options.file.string();
  auto probe = PixelProbe::open(options.file, options.view);
  if (!probe.ok()) {
    print_error(probe.error());
    return exit_file_trouble;
  }
  int code = exit_success;
  for (const PixelPlace& place : options.pixels) {
    const std::string pixel =
        file + ": pixel " + std::to_string(place.x) + "," + std::to_string(place.y) + " ";
    if (const std::string absence = probe.value().absence(place); !absence.empty()) {
      print_error(pixel + absence);
      code = exit_usage;
      continue;
    }
    const auto facts = probe.value().facts(place);
    if (!facts.ok()) {
      print_error(facts.error());
      return exit_file_trouble;
    }
    if (!facts.value()) {
      print_error(pixel + "is not rendered yet in this partial image");
      if (code == exit_success) code = exit_frame_failed;
      continue;
    }
    (options.json ? print_json : print_text)(file, place, *facts.value());
  }
  return code;
}

}  // namespace backlight
