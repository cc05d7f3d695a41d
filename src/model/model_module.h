// The C interface of libbacklight_models.so, the only thing that has tinyobjloader and a parser of JSON in
// it. The library is loaded with dlopen; nothing but plain data crosses.
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct BacklightModelMaterial {
  const char* name;
  double color[3];
  double emission[3];
  const char* texture;   ///< a path, relative to the model's folder; or null
  const char* embedded;  ///< the bytes of a picture's file; or null
  std::size_t embedded_size;
};

/// A model, until backlight_models_free.
struct BacklightModel {
  std::size_t corners;
  const double* places;   ///< three for each corner
  const double* normals;  ///< likewise; or null
  const double* texture;  ///< two for each corner, v upwards; or null
  std::size_t triangles;
  const std::uint32_t* indices;    ///< of corners, three for each triangle; in range
  const std::uint32_t* materials;  ///< by triangle
  std::size_t material_count;
  const BacklightModelMaterial* material;
  std::size_t file_count;
  const char* const* files;  ///< others that were read
  const char* missing;       ///< a file of materials that it names and that is not there; or null
  std::size_t left_out;      ///< faces of less than three corners
  void* memory;
};

#define BACKLIGHT_MODELS_EXPORT __attribute__((visibility("default")))

/// Returns 0, or 1 and a text in `error`.
BACKLIGHT_MODELS_EXPORT int backlight_models_read_v1(const char* path, int with_normals,
                                                     BacklightModel* model, char* error,
                                                     std::size_t error_size);
BACKLIGHT_MODELS_EXPORT void backlight_models_free_v1(BacklightModel* model);
}

using BacklightModelsRead = decltype(&backlight_models_read_v1);
using BacklightModelsFree = decltype(&backlight_models_free_v1);
