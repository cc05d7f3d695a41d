#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfVersion.h>
#include <ImfXdr.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "backlight/film/exr.h"
#include "exr_header.h"

namespace backlight {
namespace {

/// OpenEXR reads through this. Reading past the end leaves as an exception.
class FileStream : public Imf::IStream {
 public:
  explicit FileStream(const std::filesystem::path& path)
      : Imf::IStream(path.c_str()), file_(path, std::ios::binary) {
    std::error_code error;
    const bool folder = std::filesystem::is_directory(path, error);
    if (!file_ || folder) {
      throw std::system_error(folder ? EISDIR : errno, std::generic_category());
    }
    file_.seekg(0, std::ios::end);
    size_ = static_cast<std::uint64_t>(file_.tellg());
    file_.seekg(0);
  }

  bool read(char bytes[], int count) override {
    const std::uint64_t position = tellg();
    if (count < 0 || position > size_ || static_cast<std::uint64_t>(count) > size_ - position) {
      throw std::runtime_error("the file ends too early");
    }
    if (!file_.read(bytes, count)) {
      throw std::runtime_error("the file cannot be read");
    }
    return tellg() < size_;
  }
  std::uint64_t tellg() override { return static_cast<std::uint64_t>(file_.tellg()); }
  void seekg(std::uint64_t position) override { file_.seekg(static_cast<std::streamoff>(position)); }
  void clear() override { file_.clear(); }

 private:
  std::ifstream file_;
  std::uint64_t size_ = 0;
};

/// The first part's header. It is looked at before Imf::InputFile sees it, which trusts the windows of a
/// damaged file enough to allocate tables for them.
ExrInfo read_info(const std::filesystem::path& path) {
  FileStream stream(path);
  int magic = 0;
  int version = 0;
  Imf::Xdr::read<Imf::StreamIO>(stream, magic);
  if (magic != Imf::MAGIC) {
    throw std::runtime_error("it is not an OpenEXR file");
  }
  Imf::Xdr::read<Imf::StreamIO>(stream, version);
  if (Imf::getVersion(version) != Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version))) {
    throw std::runtime_error("it is of an unknown version of OpenEXR");
  }
  if (Imf::isNonImage(version)) {
    throw std::runtime_error("it is a deep picture");
  }
  Imf::Header header;
  header.readFrom(stream, version);
  return from_imf(header);
}

/// The pixels, from top to bottom. Memory is touched only as rows arrive, so that a damaged header that
/// announces a great picture fails at its first missing row.
Image read_pixels(const std::filesystem::path& path, ImageLayout layout) {
  FileStream stream(path);
  Imf::InputFile input(stream, 0);
  const PixelBox& data = layout.data;
  const auto width = static_cast<std::size_t>(data.width());
  const auto height = static_cast<std::size_t>(data.height());
  std::vector<std::vector<float>> planes(layout.channels.size());
  Imf::FrameBuffer buffer;
  for (std::size_t channel = 0; channel < planes.size(); ++channel) {
    planes[channel].reserve(width * height);
    buffer.insert(layout.channels[channel].name,
                  Imf::Slice::Make(Imf::FLOAT, planes[channel].data(), Imath::V2i(data.x0, data.y0),
                                   data.width(), data.height()));
  }
  input.setFrameBuffer(buffer);
  constexpr int band_rows = 64;
  for (int row = data.y0; row < data.y1; row += band_rows) {
    const int end = std::min(data.y1, row + band_rows);
    for (std::vector<float>& plane : planes) {
      plane.resize(width * static_cast<std::size_t>(end - data.y0));  // within what is reserved: stays put
    }
    input.readPixels(row, end - 1);
  }
  return Image(std::move(layout), std::move(planes));
}

/// `read()`, its exceptions turned into failures.
template <typename T>
Result<T> without_exceptions(const std::filesystem::path& path, const std::function<T()>& read) {
  const std::string what = "cannot read " + path.string() + ": ";
  try {
    return read();
  } catch (const std::bad_alloc&) {
    return Failure{what + "not enough memory"};
  } catch (const std::system_error& error) {
    return Failure{what + error.code().message()};
  } catch (const std::exception& error) {
    return Failure{what + error.what()};
  }
}

}  // namespace

Result<ExrInfo> read_exr_info(const std::filesystem::path& path) {
  return without_exceptions<ExrInfo>(path, [&] { return read_info(path); });
}

Result<ExrPicture> read_exr(const std::filesystem::path& path) {
  return without_exceptions<ExrPicture>(path, [&] {
    ExrInfo info = read_info(path);
    return ExrPicture{read_pixels(path, std::move(info.layout)), std::move(info.header)};
  });
}

}  // namespace backlight
