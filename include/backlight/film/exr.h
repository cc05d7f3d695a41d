// OpenEXR files: scanlines, ZIP, one part. The same picture and header give the same bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "backlight/base/result.h"
#include "backlight/base/variant_guard.h"
#include "backlight/base/vector.h"
#include "backlight/film/image.h"

namespace backlight {

/// The types of header attribute that are written, and kept when read: EXR's int, float, double, string, v3d
/// and stringvector.
using ExrValue =
    std::variant<std::int32_t, float, double, std::string, Vec3, std::vector<std::string>, VariantGuard>;

/// The value as a reader would write it: numbers with all their digits, lists with commas between.
std::string text_of(const ExrValue& value);

struct ExrAttribute {
  std::string name;  ///< "backlight/..." for what is ours
  ExrValue value;
};

/// What a file says about its picture besides the pixels.
struct ExrHeader {
  std::string software;  ///< attribute "Software"; empty: not written
  std::string comments;  ///< attribute "comments"; empty: not written

  /// The luminance in cd/m^2 of the film value (1, 1, 1). Film values have no absolute scale: the default is
  /// the usual reference white of Rec.709 displays.
  float white_luminance = 100.0F;

  /// Row after row, for row vectors: p_camera = p_world * M. See world_to_camera_matrix.
  std::optional<std::array<float, 16>> world_to_camera;

  /// Seconds since 1970 (UTC), written as capDate; without it no clock goes into the file. Only written: a
  /// file's capDate is read as an attribute of that name.
  std::optional<std::int64_t> creation_time;

  /// Further attributes, in any order. A name must not be one that describes the file itself ("channels",
  /// "dataWindow"...).
  std::vector<ExrAttribute> attributes;

  /// The value of attribute `name` if it is there and a `T`, else null.
  template <typename T>
  [[nodiscard]] const T* find(std::string_view name) const {
    for (const ExrAttribute& attribute : attributes) {
      if (attribute.name == name) {
        return std::get_if<T>(&attribute.value);
      }
    }
    return nullptr;
  }
};

/// The matrix that takes world points to the camera's coordinates x = right, y = up, z = backward (the camera
/// looks along -z, as Maya, Nuke and Blender have it). `right`, `up`, `forward` are orthonormal; the position
/// and the axes are those of one moment, in one frame.
std::array<float, 16> world_to_camera_matrix(const Vec3& position, const Vec3& right, const Vec3& up,
                                             const Vec3& forward);

/// The value of the environment variable SOURCE_DATE_EPOCH (reproducible-builds.org), if it is set. Fails if
/// it is not a whole number >= 0.
Result<std::optional<std::int64_t>> source_date_epoch();

/// When channels of half precision are widened to float, all of them together.
enum class ColourStorage {
  automatic,    ///< if a finite value of one of them passes half's range, |x| > 65504
  always_float  ///< always
};

/// The rows of one chunk of the files that are written: what is compressed together.
inline constexpr int exr_chunk_rows = 16;

/// Whether a value of one of the image's channels of half precision is finite and beyond its range.
bool half_overflows(const Image& image);

/// All channels as float.
void widen(ImageLayout& layout);

/// Rows as they are in a file, rounded and compressed.
struct EncodedRows {
  int first = 0;
  int count = 0;
  std::string chunks;
};

/// Writes rows from top to bottom into a temporary beside `path`; nothing is at `path` before the commit.
/// Without a commit the destructor removes the temporary. Holds a few rows, not the picture.
///
/// Half is rounded to nearest, ties to even. A writer of rows cannot look ahead, so the channels are stored
/// exactly as the layout says, and a value out of half's range makes write_rows fail.
class ExrWriter {
 public:
  /// Fails if the layout has no pixel, no channel, two channels of one name or an empty name, if the header
  /// has an attribute that cannot be written, or if the file cannot be made.
  static Result<ExrWriter> open(const std::filesystem::path& path, const ImageLayout& layout,
                                const ExrHeader& header);

  ExrWriter(ExrWriter&&) noexcept;
  ExrWriter& operator=(ExrWriter&&) noexcept;
  ~ExrWriter();

  /// Some rows of the picture, from `first` on: a plane for each channel, in the layout's order, each with
  /// `rows` rows of the data window's width. `first` begins a chunk, and the last row ends one, or the
  /// picture. Different threads may encode different rows at the same time, and while rows are written.
  [[nodiscard]] Result<EncodedRows> encode(int first, std::span<const std::span<const float>> planes,
                                           int rows) const;

  /// The next rows. After a failure every further call fails.
  Result<void> write(const EncodedRows& rows);

  /// The same of rows that are still to be encoded.
  Result<void> write_rows(std::span<const std::span<const float>> planes, int rows);

  /// Gives rows back that were written, from the begin of one chunk to the end of another, as the file has
  /// them: planes as those of encode().
  Result<void> read_back(int first, std::span<const std::span<float>> planes, int rows);

  /// Completes the file and moves it to its place. Fails if rows are missing.
  Result<void> commit();

 private:
  class Implementation;
  explicit ExrWriter(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

/// Makes what OpenEXR makes when it is first used, and cannot make again in the same process where memory
/// runs out half-way. A program that goes on after std::bad_alloc, which this throws, calls it first of all.
void begin_exr();

/// Writes a whole picture. On failure (the disk is full, the folder cannot be written...) nothing is left
/// behind, and a file that was at `path` is as it was.
Result<void> write_exr(const std::filesystem::path& path, const Image& image, const ExrHeader& header,
                       ColourStorage storage = ColourStorage::automatic);

struct ExrPicture {
  Image image;  ///< channels in alphabetical order, as in the file
  ExrHeader header;
};

/// Reads part number `part` of any flat EXR file, whatever wrote it: scanlines or tiles, of which the level
/// of full size. Attributes of other types than ExrValue's are left out. Fails on a file that is missing,
/// damaged or cut short, has no such part, is deep, has subsampled channels, or is wider or higher than 2^20
/// pixels.
Result<ExrPicture> read_exr(const std::filesystem::path& path, std::size_t part = 0);

/// The header and the layout alone, without decoding a pixel.
struct ExrInfo {
  ImageLayout layout;
  ExrHeader header;
  std::string part;       ///< its name; a file of one part need not have one
  std::size_t parts = 1;  ///< how many the file has
  std::string storage;    ///< in words: "scanlines", "tiles of 64 x 64"...
  bool tiled = false;     ///< in tiles, not in scanlines
  bool has_levels =
      false;  ///< the picture is there in smaller sizes too (mip-mapped), which read_exr does not give
  float pixel_aspect = 1.0F;  ///< width of a pixel by its height
  /// x and y of red, green, blue and white; Rec.709's and D65's where the file does not say.
  std::array<float, 8> chromaticities{};
  std::string unreadable;  ///< why read_exr fails on it, by its header: "it is a deep picture"; or empty
};

/// That of the first part. What read_exr fails on by the header, this fails on.
Result<ExrInfo> read_exr_info(const std::filesystem::path& path);

/// Those of all parts, in the file's order, also of parts that read_exr does not read. Never empty.
Result<std::vector<ExrInfo>> read_exr_parts(const std::filesystem::path& path);

/// The same of a file like those of write_exr whose pixels are all there: fails besides when a chunk is
/// missing, out of place or cut short, as in a copy that was interrupted, and on a file of several
/// parts or of another compression. Reads the heads of the chunks, not their contents.
Result<ExrInfo> read_whole_exr_info(const std::filesystem::path& path);

/// Reads rows of a part that need not fit into memory as a whole. What read_exr fails on, this fails on: in
/// `open` for the header, in `read_rows` for the rows.
class ExrReader {
 public:
  static Result<ExrReader> open(const std::filesystem::path& path, std::size_t part = 0);

  ExrReader(ExrReader&&) noexcept;
  ExrReader& operator=(ExrReader&&) noexcept;
  ~ExrReader();

  [[nodiscard]] const ExrInfo& info() const;

  /// The rows first <= j < first + count, which must lie in the data window, as planes in the order of the
  /// layout's channels: each of count * data.width() floats.
  Result<void> read_rows(int first, int count, std::span<const std::span<float>> planes);

  /// All values of a channel of whole numbers, as Image keeps them.
  Result<std::vector<std::uint32_t>> read_whole_numbers(std::size_t channel);

 private:
  class Implementation;
  explicit ExrReader(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace backlight
