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

void print_info(const std::filesystem::path& file, const ExrInfo& info) {
  const ImageLayout& layout = info.layout;
  std::cout << file.string() << ": " << layout.display.width() << " x " << layout.display.height() << '\n';
  if (layout.data != layout.display) print_row("pixels present", window_text(layout.data));
  std::string channels;
  for (const ChannelInfo& channel : layout.channels) {
    channels += (channels.empty() ? "" : " ") + channel.name +
                (channel.precision == ChannelPrecision::half ? ":half" : ":float");
  }
  print_row("channels", channels);
  std::string views;
  for (const std::string& view : layout.views) views += (views.empty() ? "" : ", ") + view;
  print_row("views", views);
  print_row("Software", info.header.software);
  print_row("comments", info.header.comments);
  for (const ExrAttribute& attribute : info.header.attributes)
    print_row(attribute.name, text_of(attribute.value));
}

}  // namespace

int run(const InfoOptions& options) {
  int code = exit_success;
  for (const std::filesystem::path& file : options.files) {
    const auto info = read_exr_info(file);
    if (info.ok()) {
      print_info(file, info.value());
    } else {
      print_error(info.error());
      code = exit_file_trouble;
    }
  }
  return code;
}

}  // namespace backlight
