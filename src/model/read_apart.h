// The libraries that read models are not made for damaged files. They do it in a process of their own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "model_module.h"
#include "read_model.h"

namespace backlight::models {

/// What such a process leaves: a model in shared memory.
class SharedModel {
 public:
  SharedModel(void* memory, std::size_t size) : memory_(memory), size_(size) {}
  SharedModel(const SharedModel&) = delete;
  SharedModel& operator=(const SharedModel&) = delete;
  ~SharedModel();

  std::vector<BacklightModelMaterial> materials;
  std::vector<const char*> files;
  [[nodiscard]] const char* begin() const { return static_cast<const char*>(memory_); }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void* memory_;
  std::size_t size_;
};

/// Fills `model`, which points into what is returned. `file_size` in bytes, by which the process has its
/// memory. Fails with the reader's own error, or with what became of the process: std::runtime_error.
std::unique_ptr<SharedModel> read_apart(const std::function<Read()>& read, std::uintmax_t file_size,
                                        BacklightModel& model);

}  // namespace backlight::models
