#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
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

#include "backlight/base/files.h"
#include "backlight/film/exr.h"
#include "exr_header.h"
#include "exr_plausible.h"

namespace backlight {
namespace {

/// OpenEXR reads through this. Reading past the end leaves as an exception.
class FileStream : public Imf::IStream {
 public:
  [[nodiscard]] std::uint64_t size() const { return size_; }

  explicit FileStream(const std::filesystem::path& path)
      : Imf::IStream(path.c_str()), file_(path, std::ios::binary) {
    if (!file_) {
      throw std::system_error(errno, std::generic_category());
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

/// The headers of all parts. They are looked at before OpenEXR's own classes see them, which trust the
/// windows of a damaged file enough to allocate tables for them.
std::vector<ExrInfo> read_headers(FileStream& stream) {
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
  const bool several = Imf::isMultiPart(version);
  check_attributes(stream, stream.size(), several);
  std::vector<ExrInfo> parts;
  do {
    Imf::Header header;
    header.readFrom(stream, version);
    if (several && header.readsNothing()) break;  // after the last one
    parts.push_back(from_imf(header));
  } while (several);
  if (parts.empty()) throw std::runtime_error("it has no part");
  if (!several && Imf::isNonImage(version)) parts.front().unreadable = "it is a deep picture";
  for (ExrInfo& info : parts) {
    info.parts = parts.size();
    if (info.unreadable.empty()) check_size(info.layout, stream.size());
  }
  return parts;
}

std::vector<ExrInfo> read_headers_of(const std::filesystem::path& path) {
  FileStream stream(path);
  return read_headers(stream);
}

/// Of part number `part`, which must be one that can be read.
ExrInfo readable(std::vector<ExrInfo> parts, std::size_t part) {
  if (part >= parts.size()) throw std::runtime_error("it has no part " + std::to_string(part + 1));
  ExrInfo info = std::move(parts[part]);
  if (!info.unreadable.empty()) throw std::runtime_error(info.unreadable);
  return info;
}

/// Walks through the chunks of a one-part scanline file by its table of offsets, which follows the header:
/// each chunk begins with its first row and its size.
void check_chunks(FileStream& stream, const ExrInfo& info) {
  const int rows = info.layout.data.height();
  const int count = (rows + exr_chunk_rows - 1) / exr_chunk_rows;
  const std::uint64_t table = stream.tellg();
  for (int chunk = 0; chunk < count; ++chunk) {
    std::uint64_t offset = 0;
    int row = 0;
    int size = 0;
    stream.seekg(table + 8 * static_cast<std::uint64_t>(chunk));
    Imf::Xdr::read<Imf::StreamIO>(stream, offset);
    if (offset < table || offset > stream.size()) throw std::runtime_error("rows of the picture are missing");
    stream.seekg(offset);
    Imf::Xdr::read<Imf::StreamIO>(stream, row);
    Imf::Xdr::read<Imf::StreamIO>(stream, size);
    const std::uint64_t left = stream.size() - offset - 8;
    if (row != info.layout.data.y0 + chunk * exr_chunk_rows || size <= 0 ||
        static_cast<std::uint64_t>(size) > left) {
      throw std::runtime_error("rows of the picture are missing");
    }
  }
}

/// `read()`, its exceptions turned into failures.
template <typename T>
Result<T> without_exceptions(const std::filesystem::path& path, const std::function<Result<T>()>& read) {
  const std::string what = "cannot read " + path.string() + ": ";
  if (const Result<void> regular = require_regular_file(path); !regular.ok()) return regular.failure();
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

class ExrReader::Implementation {
 public:
  // The headers are judged by read_headers before a table is allocated for what they announce.
  Implementation(std::filesystem::path path, std::size_t part)
      : path_(std::move(path)),
        info_(readable(read_headers_of(path_), part)),
        stream_(path_),
        file_(stream_, 0),
        input_(file_, static_cast<int>(part)) {}

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] const ExrInfo& info() const { return info_; }

  void read_rows(int first, int count, std::span<const std::span<float>> planes) {
    const ImageLayout& layout = info_.layout;
    const PixelBox& data = layout.data;
    const std::size_t pixels = static_cast<std::size_t>(data.width()) * static_cast<std::size_t>(count);
    if (count < 1 || first < data.y0 || first > data.y1 - count || planes.size() != layout.channels.size()) {
      throw std::runtime_error("the rows asked for are not in the picture");
    }
    Imf::FrameBuffer buffer;
    for (std::size_t channel = 0; channel < planes.size(); ++channel) {
      if (planes[channel].size() != pixels) throw std::runtime_error("the rows do not fit the planes");
      buffer.insert(layout.channels[channel].name,
                    Imf::Slice::Make(Imf::FLOAT, planes[channel].data(), Imath::V2i(data.x0, first),
                                     data.width(), count));
    }
    input_.setFrameBuffer(buffer);
    input_.readPixels(first, first + count - 1);
  }

  std::vector<std::uint32_t> read_whole_numbers(std::size_t channel) {
    const PixelBox& data = info_.layout.data;
    std::vector<std::uint32_t> values(static_cast<std::size_t>(data.width()) *
                                      static_cast<std::size_t>(data.height()));
    Imf::FrameBuffer buffer;
    buffer.insert(info_.layout.channels.at(channel).name,
                  Imf::Slice::Make(Imf::UINT, values.data(), Imath::V2i(data.x0, data.y0), data.width(),
                                   data.height()));
    input_.setFrameBuffer(buffer);
    input_.readPixels(data.y0, data.y1 - 1);
    return values;
  }

 private:
  std::filesystem::path path_;
  ExrInfo info_;
  FileStream stream_;
  Imf::MultiPartInputFile file_;
  Imf::InputPart input_;
};

ExrReader::ExrReader(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ExrReader::ExrReader(ExrReader&&) noexcept = default;
ExrReader& ExrReader::operator=(ExrReader&&) noexcept = default;
ExrReader::~ExrReader() = default;

Result<ExrReader> ExrReader::open(const std::filesystem::path& path, std::size_t part) {
  return without_exceptions<ExrReader>(
      path, [&] { return ExrReader(std::make_unique<Implementation>(path, part)); });
}

const ExrInfo& ExrReader::info() const {
  return implementation_->info();
}

Result<void> ExrReader::read_rows(int first, int count, std::span<const std::span<float>> planes) {
  return without_exceptions<void>(implementation_->path(), [&]() -> Result<void> {
    implementation_->read_rows(first, count, planes);
    return {};
  });
}

Result<std::vector<std::uint32_t>> ExrReader::read_whole_numbers(std::size_t channel) {
  return without_exceptions<std::vector<std::uint32_t>>(
      implementation_->path(), [&] { return implementation_->read_whole_numbers(channel); });
}

namespace {

// Memory is touched only as rows arrive, so that a damaged header that announces a great picture fails at its
// first missing row.
Result<Image> read_pixels(ExrReader& reader) {
  const ImageLayout& layout = reader.info().layout;
  const PixelBox& data = layout.data;
  const auto width = static_cast<std::size_t>(data.width());
  std::vector<std::vector<float>> planes(layout.channels.size());
  for (std::vector<float>& plane : planes) plane.reserve(width * static_cast<std::size_t>(data.height()));
  // Of a damaged file's width, a band is not much memory either.
  constexpr std::size_t band_values = std::size_t{1} << 24U;
  const int band_rows = static_cast<int>(
      std::clamp<std::size_t>(band_values / (width * std::max<std::size_t>(planes.size(), 1)), 1, 64));
  for (int row = data.y0; row < data.y1; row += band_rows) {
    const int count = std::min(data.y1 - row, band_rows);
    std::vector<std::span<float>> band;
    for (std::vector<float>& plane : planes) {
      plane.resize(plane.size() + width * static_cast<std::size_t>(count));
      band.push_back(std::span(plane).last(width * static_cast<std::size_t>(count)));
    }
    if (auto read = reader.read_rows(row, count, band); !read.ok()) return read.failure();
  }
  Image image(layout, std::move(planes));
  for (std::size_t channel = 0; channel < layout.channels.size(); ++channel) {
    if (layout.channels[channel].precision != ChannelPrecision::whole) continue;
    auto values = reader.read_whole_numbers(channel);
    if (!values.ok()) return values.failure();
    image.set_whole_numbers(channel, std::move(values).value());
  }
  return image;
}

}  // namespace

Result<ExrInfo> read_exr_info(const std::filesystem::path& path) {
  return without_exceptions<ExrInfo>(path, [&] { return readable(read_headers_of(path), 0); });
}

Result<std::vector<ExrInfo>> read_exr_parts(const std::filesystem::path& path) {
  return without_exceptions<std::vector<ExrInfo>>(path, [&] { return read_headers_of(path); });
}

Result<ExrInfo> read_whole_exr_info(const std::filesystem::path& path) {
  return without_exceptions<ExrInfo>(path, [&]() -> Result<ExrInfo> {
    FileStream stream(path);
    ExrInfo info = readable(read_headers(stream), 0);
    if (info.parts > 1 || info.tiled) throw std::runtime_error("it is not stored as one part of scanlines");
    check_chunks(stream, info);
    return info;
  });
}

Result<ExrPicture> read_exr(const std::filesystem::path& path, std::size_t part) {
  return without_exceptions<ExrPicture>(path, [&]() -> Result<ExrPicture> {
    auto reader = ExrReader::open(path, part);
    if (!reader.ok()) return reader.failure();
    auto image = read_pixels(reader.value());
    if (!image.ok()) return image.failure();
    return ExrPicture{std::move(image).value(), reader.value().info().header};
  });
}

}  // namespace backlight
