#include <IexErrnoExc.h>

#include <algorithm>
#include <exception>
#include <new>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "backlight/base/files.h"
#include "backlight/film/exr.h"
#include "exr_rows.h"

namespace backlight {
namespace {

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

std::size_t chunks_of(int rows) {
  return static_cast<std::size_t>((rows + exr_chunk_rows - 1) / exr_chunk_rows);
}

std::vector<std::span<const float>> rows_of(std::span<const std::span<const float>> planes,
                                            std::size_t first_value, std::size_t values) {
  std::vector<std::span<const float>> rows;
  for (const std::span<const float> plane : planes) rows.push_back(plane.subspan(first_value, values));
  return rows;
}

}  // namespace

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

void widen(ImageLayout& layout) {
  for (ChannelInfo& channel : layout.channels) channel.precision = ChannelPrecision::single;
}

class ExrWriter::Implementation {
 public:
  Implementation(AtomicFile file, const ImageLayout& layout, const ExrHeader& header)
      : file_(std::move(file)),
        layout_(layout),
        collected_(head_of(layout, header)),
        table_(collected_.size() - 8 * chunks_of(layout.data.height())),
        next_row_(layout.data.y0) {}

  /// Calls `work`, its exceptions turned into failures that name the file.
  template <class Work>
  auto explained(const Work& work) const -> decltype(work()) {
    const std::string what = "cannot write " + file_.path().string() + ": ";
    try {
      return work();
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const Iex::EnomemExc&) {
      throw std::bad_alloc();
    } catch (const std::exception& exception) {
      return Failure{what + exception.what()};
    }
  }

  [[nodiscard]] Result<EncodedRows> encode(int first, std::span<const std::span<const float>> planes,
                                           int rows) const {
    return explained([&]() -> Result<EncodedRows> {
      require_fit(planes, rows);
      const int end = first + rows;
      const bool is_aligned = (first - layout_.data.y0) % exr_chunk_rows == 0 &&
                              ((end - layout_.data.y0) % exr_chunk_rows == 0 || end == layout_.data.y1);
      if (!is_aligned || rows < 1 || first < layout_.data.y0 || end > layout_.data.y1)
        throw std::runtime_error("the rows do not fit the picture");
      return EncodedRows{first, rows, chunks_of_rows(layout_of_rows(layout_, first, rows), planes)};
    });
  }

  Result<void> write(const EncodedRows& rows) {
    if (!error_.empty()) return Failure{error_};
    return kept(explained([&]() -> Result<void> {
      if (rows.first != next_row_) throw std::runtime_error("the rows do not fit the picture");
      const std::vector<std::uint64_t> places = places_of(rows.chunks, file_.position() + collected_.size());
      places_.insert(places_.end(), places.begin(), places.end());
      collected_ += rows.chunks;
      next_row_ += rows.count;
      return collected_.size() >= enough ? flush() : Result<void>();
    }));
  }

  Result<void> write_rows(std::span<const std::span<const float>> planes, int rows) {
    if (!error_.empty()) return Failure{error_};
    return kept(explained([&] { return write_or_throw(planes, rows); }));
  }

  Result<void> read_back(int first, std::span<const std::span<float>> planes, int rows) {
    if (const Result<void> flushed = flush(); !flushed.ok()) return flushed;
    return explained([&]() -> Result<void> {
      const std::size_t chunk = chunks_of(first - layout_.data.y0);
      const std::size_t end = chunk + chunks_of(rows);
      if (first < layout_.data.y0 || rows < 1 || end > places_.size() ||
          planes.size() != layout_.channels.size())
        throw std::runtime_error("the rows asked for are not written");
      const std::uint64_t begin = places_[chunk];
      std::string chunks((end < places_.size() ? places_[end] : file_.position()) - begin, '\0');
      if (const auto read = file_.read_back(begin, chunks); !read.ok()) return read;
      decode_rows(layout_of_rows(layout_, first, rows), chunks, planes);
      return {};
    });
  }

  Result<void> commit() {
    if (!error_.empty()) return Failure{error_};
    if (next_row_ != layout_.data.y1) {
      return kept(Failure{"cannot write " + file_.path().string() + ": rows of the picture are missing"});
    }
    if (const Result<void> flushed = flush(); !flushed.ok()) return flushed;
    file_.seek(table_);
    if (const Result<void> written = file_.write(table_of(places_)); !written.ok()) return written;
    return file_.commit();
  }

 private:
  static constexpr std::size_t enough = std::size_t{1} << 20U;

  Result<void> kept(Result<void> result) {
    if (!result.ok()) {
      error_ = file_.status().ok() ? result.error() : file_.status().error();
      file_.abandon();
    }
    return result;
  }

  Result<void> flush() {
    const Result<void> written = file_.write(collected_);
    collected_.clear();
    return written;
  }

  void require_fit(std::span<const std::span<const float>> planes, int rows) const {
    const auto width = static_cast<std::size_t>(layout_.data.width());
    const auto fits = [&](std::span<const float> plane) {
      return plane.size() == width * static_cast<std::size_t>(rows);
    };
    if (rows < 0 || planes.size() != layout_.channels.size() || !std::ranges::all_of(planes, fits))
      throw std::runtime_error("the rows do not fit the picture");
  }

  /// Rows that do not end a chunk wait for the next.
  Result<void> write_or_throw(std::span<const std::span<const float>> planes, int rows) {
    require_fit(planes, rows);
    if (rows > layout_.data.y1 - next_row_ - waiting_rows_)
      throw std::runtime_error("the rows do not fit the picture");
    waiting_.resize(planes.size());
    for (std::size_t channel = 0; channel < planes.size(); ++channel) {
      static_cast<void>(require_half(planes[channel], layout_.channels[channel]));
      waiting_[channel].insert(waiting_[channel].end(), planes[channel].begin(), planes[channel].end());
    }
    waiting_rows_ += rows;
    const bool is_end = next_row_ + waiting_rows_ == layout_.data.y1;
    const int ready = is_end ? waiting_rows_ : waiting_rows_ - waiting_rows_ % exr_chunk_rows;
    if (ready == 0) return {};
    const auto values = static_cast<std::size_t>(ready) * static_cast<std::size_t>(layout_.data.width());
    const std::vector<std::span<const float>> all(waiting_.begin(), waiting_.end());
    const auto encoded = encode(next_row_, rows_of(all, 0, values), ready);
    if (!encoded.ok()) return encoded.failure();
    for (std::vector<float>& plane : waiting_)
      plane.erase(plane.begin(), plane.begin() + static_cast<std::ptrdiff_t>(values));
    waiting_rows_ -= ready;
    return write(encoded.value());
  }

  AtomicFile file_;
  ImageLayout layout_;
  std::string collected_;  // that the file does not have yet: it is not to be asked for a few bytes each time
  std::uint64_t table_;    // where it is in the file
  std::vector<std::uint64_t> places_;  // of the chunks
  int next_row_;
  std::vector<std::vector<float>> waiting_;  // rows of a chunk that is not full
  int waiting_rows_ = 0;
  std::string error_;
};

ExrWriter::ExrWriter(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
ExrWriter::ExrWriter(ExrWriter&&) noexcept = default;
ExrWriter& ExrWriter::operator=(ExrWriter&&) noexcept = default;
ExrWriter::~ExrWriter() = default;

Result<ExrWriter> ExrWriter::open(const std::filesystem::path& path, const ImageLayout& layout,
                                  const ExrHeader& header) {
  if (const std::string fault = fault_of(layout); !fault.empty()) {
    return Failure{"cannot write " + path.string() + ": " + fault};
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file.ok()) {
    return file.failure();
  }
  try {
    return ExrWriter(std::make_unique<Implementation>(std::move(file).value(), layout, header));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Iex::EnomemExc&) {
    throw std::bad_alloc();
  } catch (const std::exception& exception) {
    return Failure{"cannot write " + path.string() + ": " + exception.what()};
  }
}

Result<EncodedRows> ExrWriter::encode(int first, std::span<const std::span<const float>> planes,
                                      int rows) const {
  return implementation_->encode(first, planes, rows);
}

Result<void> ExrWriter::write(const EncodedRows& rows) {
  return implementation_->write(rows);
}

Result<void> ExrWriter::write_rows(std::span<const std::span<const float>> planes, int rows) {
  return implementation_->write_rows(planes, rows);
}

Result<void> ExrWriter::read_back(int first, std::span<const std::span<float>> planes, int rows) {
  return implementation_->read_back(first, planes, rows);
}

Result<void> ExrWriter::commit() {
  return implementation_->commit();
}

Result<void> write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& header,
                       ColourStorage storage) {
  ImageLayout layout = image.layout();
  if (storage == ColourStorage::always_float || half_overflows(image)) widen(layout);
  Result<ExrWriter> writer = ExrWriter::open(path, layout, header);
  if (!writer.ok()) {
    return writer.failure();
  }
  std::vector<std::span<const float>> planes;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel) {
    planes.push_back(image.plane(channel));
  }
  const auto width = static_cast<std::size_t>(layout.data.width());
  for (int row = 0; row < layout.data.height(); row += exr_chunk_rows) {
    const int count = std::min(exr_chunk_rows, layout.data.height() - row);
    const auto rows =
        rows_of(planes, width * static_cast<std::size_t>(row), width * static_cast<std::size_t>(count));
    if (Result<void> written = writer.value().write_rows(rows, count); !written.ok()) return written;
  }
  return writer.value().commit();
}

}  // namespace backlight
