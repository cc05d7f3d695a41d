#include <IexErrnoExc.h>
#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfOutputFile.h>
#include <ImfThreading.h>
#include <half.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "backlight/base/files.h"
#include "backlight/film/exr.h"
#include "exr_header.h"

namespace backlight {
namespace {

/// OpenEXR writes through this, a few bytes at a time: they are collected. A failure must leave as an
/// exception; the file keeps the reason.
class CheckedStream : public Imf::OStream {
 public:
  explicit CheckedStream(AtomicFile& file) : Imf::OStream(file.path().c_str()), file_(file) {}

  void write(const char bytes[], int count) override {
    collected_.append(bytes, static_cast<std::size_t>(count));
    // A number of 64 bits, zero: as the place of a chunk, one that was not written.
    if (count != 8 || std::any_of(bytes, bytes + 8, [](char byte) { return byte != 0; }))
      taken_ += static_cast<std::uint64_t>(count);
    if (collected_.size() >= enough) flush();
  }
  std::uint64_t tellp() override { return file_.position() + collected_.size(); }
  void seekp(std::uint64_t position) override {
    if (position == tellp()) return;
    flush();
    file_.seek(position);
  }

  /// Bytes that were written so far, wherever, without places of chunks that are not there.
  [[nodiscard]] std::uint64_t taken() const { return taken_; }

  void flush() {
    const auto written = file_.write(collected_);
    collected_.clear();
    if (!written.ok()) {
      throw std::runtime_error(written.error());
    }
  }

 private:
  static constexpr std::size_t enough = std::size_t{1} << 20U;

  AtomicFile& file_;
  std::string collected_;
  std::uint64_t taken_ = 0;
};

/// What is wrong with the layout, or nothing.
std::string fault_of(const ImageLayout& layout) {
  if (layout.display.empty() || layout.data.empty()) {
    return "the picture has no pixel";
  }
  if (layout.channels.empty()) {
    return "the picture has no channel";
  }
  std::set<std::string> names;
  for (const ChannelInfo& channel : layout.channels) {
    if (channel.name.empty() || !names.insert(channel.name).second) {
      return "two channels are called '" + channel.name + "', or one has no name";
    }
    if (channel.precision == ChannelPrecision::whole) {
      return "the channel " + channel.name + " is of whole numbers, which are only read";
    }
  }
  return {};
}

bool half_overflows(const Image& image) {
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    if (image.layout().channels[channel].precision == ChannelPrecision::half &&
        !all_within(image.plane(channel), greatest_half) &&
        !std::ranges::all_of(image.plane(channel), fits_half)) {
      return true;
    }
  }
  return false;
}

// From so many numbers on, compression takes longer than it does to wake other threads.
bool is_large(const Image& image) {
  constexpr std::size_t large = std::size_t{1} << 18U;
  return image.channel_count() > 0 && image.channel_count() * image.plane(0).size() >= large;
}

// How many threads of OpenEXR's own, which all files of the process share, help with a file. They are started
// by the first file that asks for any; where they cannot be, each file is compressed by the thread that
// writes it.
int helpers_of(int threads) {
  if (threads <= 1) return 0;
  static const bool are_there = [&] {
    try {
      Imf::setGlobalThreadCount(threads);
      return true;
    } catch (const std::exception&) {
      return false;
    }
  }();
  return are_there ? threads : 0;
}

}  // namespace

class ExrWriter::Implementation {
 public:
  Implementation(AtomicFile file, const ImageLayout& layout, const ExrHeader& header, int threads)
      : file_(std::move(file)),
        stream_(file_),
        layout_(layout),
        output_(std::make_unique<Imf::OutputFile>(stream_, to_imf(layout, header), helpers_of(threads))),
        band_rows_(zip_chunk_rows * std::max(1, 2 * helpers_of(threads))),
        next_row_(layout.data.y0) {}

  Result<void> write_rows(std::span<const std::span<const float>> planes, int rows) {
    if (!error_.empty()) {
      return Failure{error_};
    }
    try {
      write_or_throw(planes, rows);
    } catch (const std::bad_alloc&) {
      file_.abandon();
      throw;
    } catch (const Iex::EnomemExc&) {
      file_.abandon();
      throw std::bad_alloc();
    } catch (const std::exception& exception) {
      error_ = file_.status().ok() ? "cannot write " + file_.path().string() + ": " + exception.what()
                                   : file_.status().error();
      file_.abandon();
      return Failure{error_};
    }
    return {};
  }

  Result<void> commit() {
    if (!error_.empty()) {
      return Failure{error_};
    }
    if (next_row_ != layout_.data.y1) {
      error_ = "cannot write " + file_.path().string() + ": rows of the picture are missing";
      return Failure{error_};
    }
    // Writes the table of chunks, eight bytes each, and swallows what goes wrong. The file has kept that, but
    // not a lack of memory on the way to it.
    const std::uint64_t before = stream_.taken();
    output_.reset();
    const auto chunks =
        static_cast<std::uint64_t>((layout_.data.height() + zip_chunk_rows - 1) / zip_chunk_rows);
    if (file_.status().ok() && stream_.taken() - before != 8 * chunks) {
      file_.abandon();
      throw std::bad_alloc();
    }
    try {
      stream_.flush();
    } catch (const std::exception&) {  // this too
    }
    return file_.commit();
  }

 private:
  void write_or_throw(std::span<const std::span<const float>> planes, int rows) {
    const auto width = static_cast<std::size_t>(layout_.data.width());
    if (rows < 0 || rows > layout_.data.y1 - next_row_ || planes.size() != layout_.channels.size()) {
      throw std::runtime_error("the rows do not fit the picture");
    }
    for (const std::span<const float> plane : planes) {
      if (plane.size() != width * static_cast<std::size_t>(rows)) {
        throw std::runtime_error("the rows do not fit the picture");
      }
    }
    for (int first = 0; first < rows; first += band_rows_) {
      const int count = std::min(band_rows_, rows - first);
      write_band(planes, width * static_cast<std::size_t>(first), count);
    }
  }

  /// `count` <= band_rows_ rows, which start at `offset` in each plane.
  void write_band(std::span<const std::span<const float>> planes, std::size_t offset, int count) {
    const auto width = static_cast<std::size_t>(layout_.data.width());
    const std::size_t pixels = width * static_cast<std::size_t>(count);
    const Imath::V2i origin(layout_.data.x0, next_row_);
    half_bands_.resize(planes.size());
    Imf::FrameBuffer buffer;
    for (std::size_t channel = 0; channel < planes.size(); ++channel) {
      const ChannelInfo& info = layout_.channels[channel];
      const std::span<const float> values = planes[channel].subspan(offset, pixels);
      const bool narrow = info.precision == ChannelPrecision::half;
      if (narrow) {
        round_to_half(values, half_bands_[channel], info.name);
      }
      const void* data = narrow ? static_cast<const void*>(half_bands_[channel].data())
                                : static_cast<const void*>(values.data());
      const std::size_t size = narrow ? sizeof(half) : sizeof(float);
      buffer.insert(info.name, Imf::Slice::Make(narrow ? Imf::HALF : Imf::FLOAT, data, origin,
                                                static_cast<std::int64_t>(width), count, size, size * width));
    }
    output_->setFrameBuffer(buffer);
    output_->writePixels(count);
    next_row_ += count;
  }

  static void round_to_half(std::span<const float> values, std::vector<half>& rounded,
                            const std::string& channel) {
    rounded.resize(values.size());
    const bool all_fit = all_within(values, greatest_half);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!all_fit && !fits_half(values[i])) {
        throw std::runtime_error("the value " + std::to_string(values[i]) + " of channel " + channel +
                                 " is beyond half precision; store it as float");
      }
      rounded[i] = half(values[i]);
    }
  }

  AtomicFile file_;
  CheckedStream stream_;
  ImageLayout layout_;
  std::unique_ptr<Imf::OutputFile> output_;
  int band_rows_;
  int next_row_;
  std::string error_;
  std::vector<std::vector<half>> half_bands_;
};

ExrWriter::ExrWriter(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;
ExrWriter& ExrWriter::operator=(ExrWriter&&) noexcept = default;
ExrWriter::~ExrWriter() = default;

Result<ExrWriter> ExrWriter::open(const std::filesystem::path& path, const ImageLayout& layout,
                                  const ExrHeader& header, int threads) {
  if (const std::string fault = fault_of(layout); !fault.empty()) {
    return Failure{"cannot write " + path.string() + ": " + fault};
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) {
    return file.failure();
  }
  try {
    return ExrWriter(std::make_unique<Implementation>(std::move(file).value(), layout, header, threads));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Iex::EnomemExc&) {
    throw std::bad_alloc();
  } catch (const std::exception& exception) {
    const std::string why = exception.what();
    // The stream's own failures already name the file.
    return Failure{why.starts_with("cannot write ") ? why : "cannot write " + path.string() + ": " + why};
  }
}

Result<void> ExrWriter::write_rows(std::span<const std::span<const float>> planes, int rows) {
  return implementation_->write_rows(planes, rows);
}

Result<void> ExrWriter::commit() {
  return implementation_->commit();
}

Result<void> write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& header,
                       ColourStorage storage, int threads) {
  ImageLayout layout = image.layout();
  if (storage == ColourStorage::always_float || half_overflows(image)) {
    for (ChannelInfo& channel : layout.channels) {
      channel.precision = ChannelPrecision::single;
    }
  }
  Result<ExrWriter> writer = ExrWriter::open(path, layout, header, is_large(image) ? threads : 1);
  if (!writer.ok()) {
    return writer.failure();
  }
  std::vector<std::span<const float>> planes;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    planes.push_back(image.plane(channel));
  }
  if (Result<void> written = writer.value().write_rows(planes, layout.data.height()); !written.ok()) {
    return written;
  }
  return writer.value().commit();
}

}  // namespace backlight
