#include <cmath>
#include <cstdint>
#include <iomanip>
#include <iostream>
#include <string>
#include <variant>
#include <vector>

#include "backlight/base/json_text.h"
#include "backlight/film/exr.h"
#include "commands.h"
#include "exit_codes.h"
#include "messages.h"

namespace backlight {
namespace {

void print_row(const std::string& name, const std::string& value) {
  if (value.empty()) return;
  std::cout << "  " << std::left << std::setw(28) << name << ' ';
  for (const char c : value) {
    std::cout << c;
    if (c == '\n') std::cout << std::string(31, ' ');
  }
  std::cout << '\n';
}

std::string window_text(const PixelBox& box) {
  return std::to_string(box.x0) + "," + std::to_string(box.y0) + "," + std::to_string(box.x1) + "," +
         std::to_string(box.y1);
}

const char* word_of(ChannelPrecision precision) {
  if (precision == ChannelPrecision::whole) return ":uint";
  return precision == ChannelPrecision::half ? ":half" : ":float";
}

void print_info(const ExrInfo& info) {
  const ImageLayout& layout = info.layout;
  if (layout.data != layout.display) print_row("pixels present", window_text(layout.data));
  std::string channels;
  for (const ChannelInfo& channel : layout.channels) {
    channels += (channels.empty() ? "" : " ") + channel.name + word_of(channel.precision);
  }
  print_row("channels", channels);
  if (info.storage != "scanlines") print_row("stored in", info.storage);
  print_row("not read by Backlight", info.unreadable);
  if (info.pixel_aspect != 1.0F) print_row("pixel aspect ratio", text_of(info.pixel_aspect));
  std::string views;
  for (const std::string& view : layout.views) views += (views.empty() ? "" : ", ") + view;
  print_row("views", views);
  print_row("Software", info.header.software);
  print_row("comments", info.header.comments);
  for (const ExrAttribute& attribute : info.header.attributes)
    print_row(attribute.name, text_of(attribute.value));
}

void print_file(const std::filesystem::path& file, const std::vector<ExrInfo>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const PixelBox& whole = parts[i].layout.display;
    std::cout << file.string() << ": ";
    if (parts.size() > 1) {
      std::cout << "part " << i + 1 << " of " << parts.size() << ", '" << parts[i].part << "': ";
    }
    std::cout << whole.width() << " x " << whole.height() << '\n';
    print_info(parts[i]);
  }
}

// Numbers stay numbers; those that are not finite are null, lists are arrays.
std::string json_of(const ExrValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return json_quoted(*text);
  if (const auto* number = std::get_if<double>(&value)) return json_number(*number);
  if (const auto* number = std::get_if<std::int32_t>(&value)) return std::to_string(*number);
  if (const auto* vector = std::get_if<Vec3>(&value)) {
    return "[" + json_number(vector->x) + "," + json_number(vector->y) + "," + json_number(vector->z) + "]";
  }
  if (const auto* list = std::get_if<std::vector<std::string>>(&value)) {
    std::string elements;
    for (const std::string& one : *list) elements += (elements.empty() ? "" : ",") + json_quoted(one);
    return "[" + elements + "]";
  }
  const auto* single = std::get_if<float>(&value);
  return single != nullptr && std::isfinite(*single) ? text_of(value) : "null";
}

std::string json_window(const PixelBox& box) {
  return "[" + window_text(box) + "]";
}

void print_json(const std::filesystem::path& file, const ExrInfo& info, std::size_t part) {
  const ImageLayout& layout = info.layout;
  std::string line = "{";
  const auto add = [&line](const std::string& name, const std::string& json) {
    line += (line.size() > 1 ? "," : "") + json_quoted(name) + ":" + json;
  };
  add("file", json_quoted(file.string()));
  add("part", std::to_string(part + 1));
  add("parts", std::to_string(info.parts));
  add("partName", info.part.empty() ? "null" : json_quoted(info.part));
  add("width", std::to_string(layout.display.width()));
  add("height", std::to_string(layout.display.height()));
  add("dataWindow", json_window(layout.data));
  std::string channels;
  for (const ChannelInfo& channel : layout.channels) {
    channels += (channels.empty() ? "" : ",") + json_quoted(channel.name) + ":" +
                json_quoted(word_of(channel.precision) + 1);
  }
  add("channels", "{" + channels + "}");
  add("views", json_of(layout.views));
  add("storage", json_quoted(info.storage));
  add("pixelAspectRatio", text_of(info.pixel_aspect));
  add("notRead", info.unreadable.empty() ? "null" : json_quoted(info.unreadable));
  std::string attributes;
  const auto attribute = [&attributes](const std::string& name, const std::string& json) {
    attributes += (attributes.empty() ? "" : ",") + json_quoted(name) + ":" + json;
  };
  if (!info.header.software.empty()) attribute("Software", json_quoted(info.header.software));
  if (!info.header.comments.empty()) attribute("comments", json_quoted(info.header.comments));
  for (const ExrAttribute& one : info.header.attributes) attribute(one.name, json_of(one.value));
  add("attributes", "{" + attributes + "}");
  std::cout << line << "}\n";
}

}  // namespace

int run(const InfoOptions& options) {
  int code = exit_success;
  for (const std::filesystem::path& file : options.files) {
    const auto parts = read_exr_parts(file);
    if (!parts.ok()) {
      print_error(parts.error());
      code = exit_file_trouble;
    } else if (options.json) {
      for (std::size_t i = 0; i < parts.value().size(); ++i) print_json(file, parts.value()[i], i);
    } else {
      print_file(file, parts.value());
    }
  }
  return code;
}

}  // namespace backlight
