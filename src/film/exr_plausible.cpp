#include "exr_plausible.h"

#include <ImfXdr.h>

#include <stdexcept>
#include <string>

namespace backlight {
namespace {

constexpr int longest_name = 255;

std::string read_name(Imf::IStream& stream) {
  std::string name;
  for (char c = 0; stream.read(&c, 1), c != 0;) {
    if (name.size() == longest_name) throw std::runtime_error("its header is damaged: a name has no end");
    name += c;
  }
  return name;
}

/// Of one part, up to the empty name that ends it; false if that comes at once.
bool walk_header(Imf::IStream& stream, std::uint64_t file_size) {
  bool any = false;
  for (std::string name = read_name(stream); !name.empty(); name = read_name(stream)) {
    any = true;
    const std::string type = read_name(stream);
    int size = 0;
    Imf::Xdr::read<Imf::StreamIO>(stream, size);
    const std::uint64_t place = stream.tellg();
    if (size < 0 || place > file_size || static_cast<std::uint64_t>(size) > file_size - place) {
      throw std::runtime_error("the file ends too early, or its header is damaged: the attribute '" + name +
                               "' of type '" + type + "' says that it has " + std::to_string(size) +
                               " bytes");
    }
    stream.seekg(place + static_cast<std::uint64_t>(size));
  }
  return any;
}

}  // namespace

void check_attributes(Imf::IStream& stream, std::uint64_t file_size, bool several_parts) {
  const std::uint64_t begin = stream.tellg();
  while (walk_header(stream, file_size) && several_parts) {
  }
  stream.clear();
  stream.seekg(begin);
}

void check_size(const ImageLayout& layout, std::uint64_t file_size) {
  constexpr double greatest_compression = 16384.0;
  const double bytes = 2.0 * static_cast<double>(layout.channels.size()) *
                       static_cast<double>(layout.data.width()) * static_cast<double>(layout.data.height());
  if (bytes / greatest_compression <= static_cast<double>(file_size)) return;
  throw std::runtime_error("it says that it has " + std::to_string(layout.data.width()) + " x " +
                           std::to_string(layout.data.height()) + " pixels, and has " +
                           std::to_string(file_size) + " bytes");
}

}  // namespace backlight
