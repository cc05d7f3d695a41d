#include "exr_rows.h"

#include <ImfFrameBuffer.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfXdr.h>
#include <half.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "backlight/base/thread_memory.h"
#include "exr_header.h"

namespace backlight {
namespace {

/// OpenEXR writes through this into memory, and so does not see the file, whose errors it swallows in places.
class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : Imf::OStream("rows") {}

  void write(const char from[], int count) override {
    const auto size = static_cast<std::size_t>(count);
    const std::size_t over = std::min(size, bytes.size() - position_);
    bytes.replace(position_, over, from, size);
    position_ += size;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string bytes;

 private:
  std::size_t position_ = 0;  // never beyond the end
};

class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(std::string bytes) : Imf::IStream("rows"), bytes_(std::move(bytes)) {}

  bool read(char to[], int count) override {
    if (static_cast<std::size_t>(count) > bytes_.size() - position_)
      throw std::runtime_error("the rows end too early");
    position_ += bytes_.copy(to, static_cast<std::size_t>(count), position_);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = std::min<std::size_t>(position, bytes_.size()); }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

/// As half's constructor rounds a number within half's range, in a form that compilers put into vectors.
std::uint16_t rounded_to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = bits >> 16U & 0x8000U;
  const std::uint32_t magnitude = bits & 0x7fffffffU;
  // The exponents' zeros are 112 apart; of a tie the sum carries into the last bit that stays if that is odd.
  const std::uint32_t normal = (magnitude - (112U << 23U) + 0xfffU + (magnitude >> 13U & 1U)) >> 13U;
  // The last bit of a number about 1/2 is the unit of half's smallest numbers: the sum is rounded to it.
  const float raised = std::bit_cast<float>(magnitude) + 0.5F;
  const std::uint32_t subnormal = std::bit_cast<std::uint32_t>(raised) - std::bit_cast<std::uint32_t>(0.5F);
  return static_cast<std::uint16_t>(sign | (magnitude < (113U << 23U) ? subnormal : normal));
}

/// Two bytes of a value, the lower ones first: a half, or a half of a float.
using Words = std::vector<std::uint16_t>;

/// Each puts values at `to` and returns the place behind them.
std::uint16_t* put_halves(std::span<const float> values, bool all_in_range, std::uint16_t* to) {
  if (all_in_range) return std::ranges::transform(values, to, rounded_to_half).out;
  return std::ranges::transform(values, to, [](float value) { return half(value).bits(); }).out;
}

std::uint16_t* put_floats(std::span<const float> values, std::uint16_t* to) {
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    *to++ = static_cast<std::uint16_t>(bits);
    *to++ = static_cast<std::uint16_t>(bits >> 16U);
  }
  return to;
}

std::size_t words_of_row(const ImageLayout& rows) {
  std::size_t words = 0;
  for (const ChannelInfo& channel : rows.channels)
    words += channel.precision == ChannelPrecision::half ? 1 : 2;
  return words * static_cast<std::size_t>(rows.data.width());
}

/// All lower bytes, then all upper ones, each byte but the first as its difference from the one before, plus
/// 128: what EXR's ZIP hands to zlib.
void split_into_differences(std::span<const std::uint16_t> words, std::vector<std::uint8_t>& bytes) {
  bytes.resize(2 * words.size());
  // Plain pointers: a byte that is written might be a part of a vector's own, which would be read anew for
  // each.
  const std::size_t count = words.size();
  const std::uint16_t* const word = words.data();
  std::uint8_t* const lower = bytes.data();
  std::uint8_t* const upper = lower + count;
  for (std::size_t i = 1; i < count; ++i) {
    lower[i] = static_cast<std::uint8_t>(word[i] - word[i - 1] + 128);
    upper[i] = static_cast<std::uint8_t>((word[i] >> 8U) - (word[i - 1] >> 8U) + 128);
  }
  lower[0] = static_cast<std::uint8_t>(word[0]);
  upper[0] = static_cast<std::uint8_t>((word[0] >> 8U) - word[count - 1] + 128);
}

/// Makes one chunk after the other, in the same memory.
class ChunkMaker {
 public:
  explicit ChunkMaker(int level) {
    if (deflateInit(&stream_, level) != Z_OK) throw std::bad_alloc();
  }
  ~ChunkMaker() { deflateEnd(&stream_); }
  ChunkMaker(const ChunkMaker&) = delete;
  ChunkMaker& operator=(const ChunkMaker&) = delete;

  /// Appends the chunk of these values, of which the first row is number `row`.
  void append(int row, const Words& words, std::string& chunks) {
    split_into_differences(words, differences_);
    // Chunks of an empty sky follow one another.
    if (differences_ != packed_differences_) pack();
    // What does not get smaller is stored as it is.
    const bool is_smaller = packed_size_ < 2 * words.size();
    const std::size_t stored = is_smaller ? packed_size_ : 2 * words.size();
    char numbers[8];
    char* next = numbers;
    Imf::Xdr::write<Imf::CharPtrIO>(next, row);
    Imf::Xdr::write<Imf::CharPtrIO>(next, static_cast<int>(stored));
    chunks.append(numbers, sizeof numbers);
    if (is_smaller) {
      chunks.append(reinterpret_cast<const char*>(packed_.data()), stored);
    } else {
      for (const std::uint16_t word : words) {
        chunks += static_cast<char>(word & 255U);
        chunks += static_cast<char>(word >> 8U);
      }
    }
  }

 private:
  void pack() {
    packed_differences_.clear();  // should it fail
    packed_.resize(deflateBound(&stream_, differences_.size()));
    stream_.next_in = differences_.data();
    stream_.avail_in = static_cast<uInt>(differences_.size());
    stream_.next_out = packed_.data();
    stream_.avail_out = static_cast<uInt>(packed_.size());
    const bool is_packed = deflate(&stream_, Z_FINISH) == Z_STREAM_END;
    packed_size_ = packed_.size() - stream_.avail_out;
    if (deflateReset(&stream_) != Z_OK || !is_packed) throw std::runtime_error("zlib fails");
    std::swap(packed_differences_, differences_);
  }

  z_stream stream_{};
  std::vector<std::uint8_t> differences_;
  std::vector<std::uint8_t> packed_differences_;  // of which `packed_` is made
  std::vector<std::uint8_t> packed_;
  std::size_t packed_size_ = 0;
};

/// In the order of the file.
std::vector<std::size_t> by_name(const std::vector<ChannelInfo>& channels) {
  std::vector<std::size_t> order(channels.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t channel) { return channels[channel].name; });
  return order;
}

Imf::Slice slice(std::span<float> plane, const PixelBox& data) {
  return Imf::Slice::Make(Imf::FLOAT, plane.data(), Imath::V2i(data.x0, data.y0), data.width(),
                          data.height());
}

}  // namespace

bool require_half(std::span<const float> values, const ChannelInfo& channel) {
  if (channel.precision != ChannelPrecision::half) return false;
  if (all_within(values, greatest_half)) return true;
  const auto beyond = std::ranges::find_if_not(values, fits_half);
  if (beyond == values.end()) return false;
  throw std::runtime_error("the value " + std::to_string(*beyond) + " of channel " + channel.name +
                           " is beyond half precision; store it as float");
}

ImageLayout layout_of_rows(const ImageLayout& layout, int first, int rows) {
  const PixelBox box{layout.data.x0, first, layout.data.x1, first + rows};
  return {box, box, layout.channels, {}};
}

/// What a file has before its first chunk: the header, and an empty table of the chunks' places.
std::string head_of(const ImageLayout& layout, const ExrHeader& header) {
  MemoryOutput stream;
  const Imf::OutputFile file(stream, to_imf(layout, header), 0);
  return stream.bytes;
}

std::string chunks_of_rows(const ImageLayout& rows, std::span<const std::span<const float>> planes) {
  // A thread makes many chunks, and fresh memory for each costs more than all else but zlib.
  static constinit thread_local ThreadMemory<ChunkMaker> maker_memory;
  static constinit thread_local ThreadMemory<Words> words_memory;
  ChunkMaker& maker = maker_memory.get(Imf::Header().zipCompressionLevel());
  Words& words = words_memory.get();
  std::vector<std::uint8_t> all_in_range;
  for (std::size_t channel = 0; channel < planes.size(); ++channel)
    all_in_range.push_back(require_half(planes[channel], rows.channels[channel]) ? 1 : 0);
  const std::vector<std::size_t> order = by_name(rows.channels);
  const auto width = static_cast<std::size_t>(rows.data.width());
  std::string chunks;
  for (int first = rows.data.y0; first < rows.data.y1; first += exr_chunk_rows) {
    const int end = std::min(first + exr_chunk_rows, rows.data.y1);
    words.resize(words_of_row(rows) * static_cast<std::size_t>(end - first));
    std::uint16_t* to = words.data();
    for (int row = first; row < end; ++row) {
      const std::size_t begin = width * static_cast<std::size_t>(row - rows.data.y0);
      for (const std::size_t channel : order) {
        const std::span<const float> values = planes[channel].subspan(begin, width);
        const bool is_half = rows.channels[channel].precision == ChannelPrecision::half;
        to = is_half ? put_halves(values, all_in_range[channel] != 0, to) : put_floats(values, to);
      }
    }
    maker.append(first, words, chunks);
  }
  return chunks;
}

void decode_rows(const ImageLayout& rows, const std::string& chunks,
                 std::span<const std::span<float>> planes) {
  std::string bytes = head_of(rows, {});
  const std::string table = table_of(places_of(chunks, bytes.size()));
  bytes.replace(bytes.size() - table.size(), table.size(), table);
  MemoryInput stream(bytes + chunks);
  Imf::InputFile file(stream, 0);
  Imf::FrameBuffer buffer;
  for (std::size_t channel = 0; channel < planes.size(); ++channel)
    buffer.insert(rows.channels[channel].name, slice(planes[channel], rows.data));
  file.setFrameBuffer(buffer);
  file.readPixels(rows.data.y0, rows.data.y1 - 1);
}

/// The place of each chunk in `chunks`, which begin at `begin` in their file.
std::vector<std::uint64_t> places_of(const std::string& chunks, std::uint64_t begin) {
  std::vector<std::uint64_t> places;
  const char* const end = chunks.data() + chunks.size();
  for (const char* chunk = chunks.data(); chunk < end;) {
    places.push_back(begin + static_cast<std::uint64_t>(chunk - chunks.data()));
    int row = 0;
    int size = 0;
    Imf::Xdr::read<Imf::CharPtrIO>(chunk, row);
    Imf::Xdr::read<Imf::CharPtrIO>(chunk, size);
    chunk += size;
  }
  return places;
}

std::string table_of(const std::vector<std::uint64_t>& places) {
  std::string table(8 * places.size(), '\0');
  char* next = table.data();
  for (const std::uint64_t place : places) Imf::Xdr::write<Imf::CharPtrIO>(next, place);
  return table;
}

}  // namespace backlight
