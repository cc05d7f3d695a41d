// libbacklight_oiio.so: see oiio_module.h. Independent of the rest of the program.
#include "oiio_module.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>
#include <fontconfig/fontconfig.h>
#include <freetype/freetype.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};
template <typename T>
using Memory = std::unique_ptr<T[], FreeMemory>;

template <typename T>
Memory<T> allocate(std::size_t count) {
  Memory<T> memory(static_cast<T*>(std::malloc(count * sizeof(T))));
  if (!memory) {
    throw std::bad_alloc();
  }
  return memory;
}

/// Runs `work`, its exceptions turned into texts.
template <typename Work>
int guarded(char* error, std::size_t error_size, const Work& work) {
  std::string text = "unknown error";
  try {
    work();
    return 0;
  } catch (const std::bad_alloc&) {
    text = "not enough memory";
  } catch (const std::exception& exception) {
    text = exception.what();
  } catch (...) {
  }
  if (error_size > 0) {
    const std::size_t count = std::min(text.size(), error_size - 1);
    std::memcpy(error, text.data(), count);
    error[count] = '\0';
  }
  return 1;
}

/// Throws the first line of OpenImageIO's text (the next ones repeat it), or `otherwise` where it gives none.
[[noreturn]] void raise(const std::string& text, const char* otherwise) {
  const std::string line = text.substr(0, text.find('\n'));
  throw std::runtime_error(line.empty() ? otherwise : line);
}

/// Of pixels that a texture may have: 3 GB as float numbers.
constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

/// No format packs more pixels into a byte, JPEG not even so many: what announces more is damaged, and not
/// worth the memory.
constexpr std::int64_t most_pixels_of_byte = 4096;
constexpr std::int64_t most_pixels_of_jpeg_byte = 512;

void check_size(std::int64_t bytes, const OIIO::ImageInput& input) {
  const OIIO::ImageSpec& spec = input.spec();
  const std::int64_t pixels = std::int64_t{spec.width} * spec.height;
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height) + " pixels";
  if (pixels > most_pixels) {
    throw std::runtime_error("it has " + size + ", and a texture has at most " + std::to_string(most_pixels) +
                             " pixels");
  }
  const bool jpeg = std::string_view(input.format_name()) == "jpeg";
  if (pixels / (jpeg ? most_pixels_of_jpeg_byte : most_pixels_of_byte) > bytes) {
    throw std::runtime_error("it says that it has " + size + ", and has " + std::to_string(bytes) + " bytes");
  }
}

/// Where a file has its colour: which of its pictures, the first of the channels, and their number, 1 or 3.
struct ColourPlace {
  int picture = 0;
  int first = 0;
  int channels = 0;  ///< 0: it has none
};

ColourPlace colour_in(const OIIO::ImageSpec& spec, int picture, bool is_exr) {
  const auto& names = spec.channelnames;
  for (std::size_t i = 0; i + 3 <= names.size(); ++i) {
    if (names[i] == "R" && names[i + 1] == "G" && names[i + 2] == "B") {
      return {picture, static_cast<int>(i), 3};
    }
  }
  // The channels of an OpenEXR file may be anything: distances, identifiers. One alone is taken as grey.
  if (is_exr && spec.nchannels > 1) {
    const auto grey = std::find(names.begin(), names.end(), "Y");
    if (grey == names.end()) return {picture, 0, 0};
    return {picture, static_cast<int>(grey - names.begin()), 1};
  }
  return {picture, 0, spec.nchannels >= 3 ? 3 : 1};
}

/// Of an OpenEXR file of several parts, the first one with colour; else the file's first picture.
ColourPlace find_colour(OIIO::ImageInput& input) {
  const bool is_exr = std::string_view(input.format_name()) == "openexr";
  std::string present;
  for (int picture = 0; input.seek_subimage(picture, 0); ++picture) {
    const ColourPlace place = colour_in(input.spec(), picture, is_exr);
    if (place.channels > 0) return place;
    for (const std::string& name : input.spec().channelnames) present += (present.empty() ? "" : ", ") + name;
  }
  throw std::runtime_error("it has no channels R, G and B, nor Y; there are " + present);
}

/// Turns the picture as a camera's Orientation tag says.
Memory<float> upright(OIIO::ImageSpec& spec, Memory<float> pixels, int channels) {
  const int orientation = spec.get_int_attribute("Orientation", 1);
  if (orientation <= 1 || orientation > 8) {
    return pixels;
  }
  OIIO::ImageSpec plain(spec.width, spec.height, channels, OIIO::TypeDesc::FLOAT);
  plain.attribute("Orientation", orientation);
  const OIIO::ImageBuf turned = OIIO::ImageBufAlgo::reorient(OIIO::ImageBuf(plain, pixels.get()));
  spec.width = turned.spec().width;
  spec.height = turned.spec().height;
  if (!turned.get_pixels(turned.roi(), OIIO::TypeDesc::FLOAT, pixels.get())) {
    raise(turned.geterror(), "the picture cannot be turned upright");
  }
  return pixels;
}

void take(OIIO::ImageInput* input, std::int64_t bytes, BacklightOiioImage& image) {
  if (input == nullptr) {
    raise(OIIO::geterror(), "the file cannot be opened");
  }
  const auto [picture, first, channels] = find_colour(*input);
  OIIO::ImageSpec spec = input->spec();
  if (spec.depth > 1 || spec.deep || spec.width <= 0 || spec.height <= 0) {
    throw std::runtime_error("not a flat picture");
  }
  check_size(bytes, *input);
  if (spec.full_width != spec.width || spec.full_height != spec.height || spec.full_x != spec.x ||
      spec.full_y != spec.y) {
    throw std::runtime_error("only a part of the picture is in the file (its data window is a crop)");
  }
  const std::size_t count = static_cast<std::size_t>(spec.width) * static_cast<std::size_t>(spec.height);
  // Not touched before it is decoded: a damaged file may end long before.
  Memory<float> stored = allocate<float>(count * static_cast<std::size_t>(channels));
  // A JPEG that is cut short is filled up with grey, and read "successfully" with an error left to be
  // fetched.
  if (!input->read_image(picture, 0, first, first + channels, OIIO::TypeDesc::FLOAT, stored.get()) ||
      input->has_error()) {
    raise(input->geterror(), "the file is damaged or cut short");
  }
  stored = upright(spec, std::move(stored), channels);
  Memory<float> rgb = allocate<float>(3 * count);
  for (std::size_t i = 0; i < 3 * count; ++i) {
    rgb[i] = channels == 3 ? stored[i] : stored[i / 3];
  }
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  image.width = spec.width;
  image.height = spec.height;
  image.integer_samples = spec.format.is_floating_point() ? 0 : 1;
  image.sample_bits = static_cast<int>(8 * spec.format.basesize());
  image.declared_linear = space == "Linear" || space == "linear" ? 1 : 0;
  image.pixels = rgb.release();
}

OIIO::ImageSpec plain_colours() {
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);  // the colours as they are in the file
  return config;
}

void load(const char* path, BacklightOiioImage& image) {
  const OIIO::ImageSpec config = plain_colours();
  const auto input = OIIO::ImageInput::open(path, &config);
  take(input.get(), static_cast<std::int64_t>(OIIO::Filesystem::file_size(path)), image);
}

void decode(const char* bytes, std::size_t size, BacklightOiioImage& image) {
  OIIO::ImageSpec config = plain_colours();
  const bool png = std::string_view(bytes, size).starts_with("\x89PNG");
  OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes), size);  // which it does not change
  void* proxy = static_cast<OIIO::Filesystem::IOProxy*>(&memory);
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  const auto input = OIIO::ImageInput::open(png ? "texture.png" : "texture.jpg", &config);
  take(input.get(), static_cast<std::int64_t>(size), image);
}

void encode_png(const void* samples, int width, int height, int channels, int sample_bits,
                BacklightOiioBytes& png) {
  const OIIO::TypeDesc type = sample_bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8;
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create("png");
  if (!output) {
    raise(OIIO::geterror(), "OpenImageIO has no PNG writer");
  }
  if (!output->set_ioproxy(&memory)) {
    throw std::runtime_error("OpenImageIO cannot write PNG into memory");
  }
  OIIO::ImageSpec spec(width, height, channels, type);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (!output->open("memory.png", spec) || !output->write_image(type, samples) || !output->close()) {
    raise(output->geterror(), "the PNG cannot be encoded");
  }
  Memory<unsigned char> data = allocate<unsigned char>(bytes.size());
  std::copy(bytes.begin(), bytes.end(), data.get());
  png.size = bytes.size();
  png.data = data.release();
}

void colour_map(const float* values, int width, int height, const char* map, unsigned char* rgb) {
  // Only read: ImageBuf has no constructor for constant memory.
  OIIO::ImageBuf source(OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT), const_cast<float*>(values));
  const OIIO::ImageBuf colours = OIIO::ImageBufAlgo::color_map(source, 0, map);
  if (colours.has_error() || !colours.get_pixels(colours.roi(), OIIO::TypeDesc::UINT8, rgb)) {
    raise(colours.geterror(), "the colours cannot be mapped");
  }
}

/// The file of the machine's font that comes nearest to DejaVu Sans, which Debian's fontconfig brings.
std::string font_file() {
  const std::unique_ptr<FcPattern, void (*)(FcPattern*)> wanted(
      FcPatternBuild(nullptr, FC_FAMILY, FcTypeString, "DejaVu Sans", FC_SCALABLE, FcTypeBool, FcTrue,
                     nullptr),
      FcPatternDestroy);
  if (!wanted) throw std::bad_alloc();
  FcConfigSubstitute(nullptr, wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult result = FcResultNoMatch;
  const std::unique_ptr<FcPattern, void (*)(FcPattern*)> font(FcFontMatch(nullptr, wanted.get(), &result),
                                                              FcPatternDestroy);
  FcChar8* file = nullptr;
  if (!font || FcPatternGetString(font.get(), FC_FILE, 0, &file) != FcResultMatch)
    throw std::runtime_error("there is no font on this machine (Debian: apt install fonts-dejavu-core)");
  return reinterpret_cast<const char*>(file);
}

// FreeType writes letters; OpenImageIO's own render_text takes all characters beyond ASCII for others.
void require(FT_Error error, const char* what) {
  if (error != 0) throw std::runtime_error(what);
}

/// A letter's picture of greys, mixed into the pixels with its lower left at (x, y).
void mix(const FT_GlyphSlot& letter, unsigned char* rgb, int width, int height, int x, int y,
         const float* colour) {
  const FT_Bitmap& grey = letter->bitmap;
  for (int row = 0; row < static_cast<int>(grey.rows); ++row) {
    for (int column = 0; column < static_cast<int>(grey.width); ++column) {
      const int to_x = x + letter->bitmap_left + column;
      const int to_y = y - letter->bitmap_top + row;
      if (to_x < 0 || to_x >= width || to_y < 0 || to_y >= height) continue;
      const float share = static_cast<float>(grey.buffer[row * grey.pitch + column]) / 255.0F;
      unsigned char* const pixel = rgb + 3 * (std::ptrdiff_t{to_y} * width + to_x);
      for (int k = 0; k < 3; ++k) {
        const float mixed = static_cast<float>(pixel[k]) * (1.0F - share) + 255.0F * colour[k] * share;
        pixel[k] = static_cast<unsigned char>(mixed + 0.5F);
      }
    }
  }
}

std::vector<FcChar32> characters_of(const char* text) {
  std::vector<FcChar32> characters;
  const auto* at = reinterpret_cast<const FcChar8*>(text);
  for (int left = static_cast<int>(std::strlen(text)); left > 0;) {
    FcChar32 character = 0;
    int bytes = FcUtf8ToUcs4(at, &character, left);
    if (bytes <= 0) {
      character = 0xFFFD;  // not UTF-8
      bytes = 1;
    }
    characters.push_back(character);
    at += bytes;
    left -= bytes;
  }
  return characters;
}

void write_text(unsigned char* rgb, int width, int height, int x, int y, int side, int size,
                const float* colour, const char* text) {
  FT_Library library = nullptr;
  require(FT_Init_FreeType(&library), "FreeType cannot be set up");
  const std::unique_ptr<FT_LibraryRec_, FT_Error (*)(FT_Library)> end(library, FT_Done_FreeType);
  FT_Face face = nullptr;
  require(FT_New_Face(library, font_file().c_str(), 0, &face), "the font cannot be read");
  require(FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size)), "the font has no such size");
  const std::vector<FcChar32> characters = characters_of(text);
  // First how long it is, then the letters.
  FT_Pos length = 0;
  for (const bool draws : {false, true}) {
    FT_Pos pen = 0;
    const FT_Pos begin = side < 0 ? 0 : side > 0 ? length : length / 2;
    for (const FcChar32 character : characters) {
      require(FT_Load_Char(face, character, draws ? FT_LOAD_RENDER : FT_LOAD_DEFAULT),
              "a letter cannot be drawn");
      if (draws) mix(face->glyph, rgb, width, height, x + static_cast<int>((pen - begin) / 64), y, colour);
      pen += face->glyph->advance.x;
    }
    length = pen;
  }
}

void base64(const char* data, std::size_t size, BacklightOiioBytes& bytes) {
  const std::string text = OIIO::Strutil::base64_encode({data, size});
  Memory<unsigned char> copy = allocate<unsigned char>(text.size());
  std::copy(text.begin(), text.end(), copy.get());
  bytes.size = text.size();
  bytes.data = copy.release();
}

}  // namespace

int backlight_oiio_load_v1(const char* path, BacklightOiioImage* image, char* error, std::size_t error_size) {
  return guarded(error, error_size, [&] { load(path, *image); });
}

int backlight_oiio_decode_v1(const char* bytes, std::size_t size, BacklightOiioImage* image, char* error,
                             std::size_t error_size) {
  return guarded(error, error_size, [&] { decode(bytes, size, *image); });
}

int backlight_oiio_encode_png_v1(const void* samples, int width, int height, int channels, int sample_bits,
                                 BacklightOiioBytes* png, char* error, std::size_t error_size) {
  return guarded(error, error_size, [&] { encode_png(samples, width, height, channels, sample_bits, *png); });
}

int backlight_oiio_colour_map_v1(const float* values, int width, int height, const char* map,
                                 unsigned char* rgb, char* error, std::size_t error_size) {
  return guarded(error, error_size, [&] { colour_map(values, width, height, map, rgb); });
}

int backlight_oiio_base64_v1(const char* data, std::size_t size, BacklightOiioBytes* text, char* error,
                             std::size_t error_size) {
  return guarded(error, error_size, [&] { base64(data, size, *text); });
}

int backlight_oiio_write_v1(unsigned char* rgb, int width, int height, int x, int y, int side, int size,
                            const float* colour, const char* text, char* error, std::size_t error_size) {
  return guarded(error, error_size, [&] { write_text(rgb, width, height, x, y, side, size, colour, text); });
}

void backlight_oiio_free_v1(void* memory) {
  std::free(memory);
}
