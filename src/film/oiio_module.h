// The C interface of libbacklight_oiio.so, the only thing that links OpenImageIO. The library is loaded with
// dlopen; nothing but plain data crosses. Functions that can fail return 0, or 1 and a text in `error`.
#pragma once

#include <cstddef>

extern "C" {

/// A picture read from a file: red, green, blue interleaved, row after row from the top, as stored (integers
/// scaled to 0..1, nothing linearised). `pixels` is freed by backlight_oiio_free.
struct BacklightOiioImage {
  int width;
  int height;
  int integer_samples;  ///< 1: the file stores integers; 0: floats
  int sample_bits;      ///< of one sample in the file: 8, 16, 32...
  int declared_linear;  ///< 1: the file says that its values are linear
  float* pixels;
};

/// Bytes made by the module, freed by backlight_oiio_free.
struct BacklightOiioBytes {
  unsigned char* data;
  std::size_t size;
};

// The names carry the interface's version: a module of another version is not found to have them.
#define BACKLIGHT_OIIO_EXPORT __attribute__((visibility("default")))

BACKLIGHT_OIIO_EXPORT int backlight_oiio_load_v1(const char* path, BacklightOiioImage* image, char* error,
                                                 std::size_t error_size);

/// The same of the bytes of a PNG or JPEG file.
BACKLIGHT_OIIO_EXPORT int backlight_oiio_decode_v1(const char* bytes, std::size_t size,
                                                   BacklightOiioImage* image, char* error,
                                                   std::size_t error_size);

/// `samples`: width * height * channels unsigned integers of 8 or 16 bits, sRGB; channels 1, 3 or 4.
BACKLIGHT_OIIO_EXPORT int backlight_oiio_encode_png_v1(const void* samples, int width, int height,
                                                       int channels, int sample_bits, BacklightOiioBytes* png,
                                                       char* error, std::size_t error_size);

/// `values`: width * height numbers 0..1. `map`: one of OpenImageIO's color_map. `rgb`: 3 bytes a value.
BACKLIGHT_OIIO_EXPORT int backlight_oiio_colour_map_v1(const float* values, int width, int height,
                                                       const char* map, unsigned char* rgb, char* error,
                                                       std::size_t error_size);

/// RFC 4648 base64 of `size` bytes.
BACKLIGHT_OIIO_EXPORT int backlight_oiio_base64_v1(const char* data, std::size_t size,
                                                   BacklightOiioBytes* text, char* error,
                                                   std::size_t error_size);

/// Writes a line of UTF-8 text, in the sans serif font that fontconfig finds, into `rgb`, width * height
/// pixels of 3 bytes. (x, y): on the baseline, the text's left end, middle or right end as `side` is -1, 0
/// or 1. `size`: in pixels. `colour`: 3 numbers 0..1.
BACKLIGHT_OIIO_EXPORT int backlight_oiio_write_v1(unsigned char* rgb, int width, int height, int x, int y,
                                                  int side, int size, const float* colour, const char* text,
                                                  char* error, std::size_t error_size);

BACKLIGHT_OIIO_EXPORT void backlight_oiio_free_v1(void* memory);
}

// As the loader casts what dlsym finds.
using BacklightOiioLoad = decltype(&backlight_oiio_load_v1);
using BacklightOiioDecode = decltype(&backlight_oiio_decode_v1);
using BacklightOiioEncodePng = decltype(&backlight_oiio_encode_png_v1);
using BacklightOiioColourMap = decltype(&backlight_oiio_colour_map_v1);
using BacklightOiioBase64 = decltype(&backlight_oiio_base64_v1);
using BacklightOiioWrite = decltype(&backlight_oiio_write_v1);
using BacklightOiioFree = decltype(&backlight_oiio_free_v1);
