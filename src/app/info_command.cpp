#include <iomanip>
#include <iostream>
#include <string>

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

}  // namespace

int run(const InfoOptions& options) {
  int code = exit_success;
  for (const std::filesystem::path& file : options.files) {
    const auto parts = read_exr_parts(file);
    if (parts.ok()) {
      print_file(file, parts.value());
    } else {
      print_error(parts.error());
      code = exit_file_trouble;
    }
  }
  return code;
}

}  // namespace backlight
