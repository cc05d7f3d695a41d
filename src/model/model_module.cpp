// libbacklight_models.so: see model_module.h. Independent of the rest of the program.
#include "model_module.h"

#include <algorithm>
#include <cstring>
#include <exception>
#include <filesystem>
#include <memory>
#include <new>
#include <string>

#include "read_apart.h"
#include "read_model.h"

namespace {

using namespace backlight::models;

Read read_file(const std::string& path, bool normals) {
  const std::string ending = lower(std::filesystem::path(path).extension().string());
  if (ending == ".obj") return read_obj(path, normals);
  if (ending == ".ply") return read_ply(path, normals);
  if (ending == ".stl") return read_stl(path);
  return read_gltf(path, normals);
}

}  // namespace

extern "C" {

int backlight_models_read_v1(const char* path, int with_normals, BacklightModel* model, char* error,
                             std::size_t error_size) {
  std::string text = "unknown error";
  try {
    const auto read = [&] { return read_file(path, with_normals != 0); };
    model->memory = read_apart(read, std::filesystem::file_size(path), *model).release();
    return 0;
  } catch (const std::bad_alloc&) {
    text = "not enough memory";
  } catch (const std::exception& exception) {
    text = exception.what();
  }
  if (error_size > 0) {
    const std::size_t count = std::min(text.size(), error_size - 1);
    std::memcpy(error, text.data(), count);
    error[count] = '\0';
  }
  return 1;
}

void backlight_models_free_v1(BacklightModel* model) {
  delete static_cast<SharedModel*>(model->memory);
}
}
