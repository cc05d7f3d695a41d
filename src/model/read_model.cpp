#include "read_model.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace backlight::models {

std::uint32_t Read::add_corner(const Triple& place) {
  if (!std::isfinite(0.0 * place[0] + 0.0 * place[1] + 0.0 * place[2]))
    throw std::runtime_error("it has a number that is not finite");
  if (places.size() >= 3 * most_triangles) throw std::runtime_error("it has too many vertices");
  places.push_back(place);
  return static_cast<std::uint32_t>(places.size() - 1);
}

void Read::add_texture(double u, double v) {
  if (!std::isfinite(0.0 * u + 0.0 * v)) throw std::runtime_error("it has a number that is not finite");
  texture.resize(places.size());
  texture.back() = {u, v};
}

void Read::add_normal(const Triple& normal) {
  normals.resize(places.size());
  normals.back() = std::isfinite(normal[0] + normal[1] + normal[2]) ? normal : Triple{};
}

void Read::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t material) {
  if (materials_of_triangles.size() >= most_triangles)
    throw std::runtime_error("it has more than " + std::to_string(most_triangles) + " triangles");
  indices.insert(indices.end(), {a, b, c});
  materials_of_triangles.push_back(material);
}

void Read::finish() {
  if (!texture.empty()) texture.resize(places.size());
  if (!has_normals || normals.size() < places.size()) normals.clear();
}

void fail_of_index(const std::string& index, std::size_t count, const char* what) {
  throw std::runtime_error("a face names " + std::string(what) + " " + index + ", and there are " +
                           std::to_string(count));
}

std::uint32_t index_below(std::size_t count, double number, const char* what) {
  if (!(number >= 0.0 && number < static_cast<double>(count)) || number != std::floor(number)) {
    std::ostringstream text;
    text << std::setprecision(17) << number;
    fail_of_index(text.str(), count, what);
  }
  return static_cast<std::uint32_t>(number);
}

FileBytes::FileBytes(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (file < 0 || fstat(file, &status) != 0 || !S_ISREG(status.st_mode)) {
    if (file >= 0) close(file);
    throw std::runtime_error("the file '" + path + "' cannot be opened");
  }
  size_ = static_cast<std::size_t>(status.st_size);
  void* const mapped = size_ > 0 ? mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, file, 0) : nullptr;
  close(file);
  if (mapped == MAP_FAILED) throw std::runtime_error("the file '" + path + "' cannot be read");
  if (mapped != nullptr) data_ = static_cast<const char*>(mapped);
}

FileBytes::~FileBytes() {
  if (size_ > 0) munmap(const_cast<char*>(data_), size_);
}

std::string_view next_word(std::string_view& text, std::string_view space) {
  const auto is_space = [&](char c) { return space.find(c) != std::string_view::npos; };
  std::size_t begin = 0;
  while (begin < text.size() && is_space(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !is_space(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

bool is_number(std::string_view word, double& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto read = std::from_chars(word.data(), end, value);
  if (read.ptr != end || word.empty()) return false;
  // What is too small for a number is 0; from_chars leaves the value alone.
  if (read.ec == std::errc::result_out_of_range) {
    const std::size_t power = word.find_first_of("eE");
    if (power == std::string_view::npos || !word.substr(power + 1).starts_with('-')) return false;
    value = 0.0;
    return true;
  }
  return read.ec == std::errc() && std::isfinite(value);
}

std::string lower(std::string_view text) {
  std::string result(text);
  std::ranges::transform(result, result.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

}  // namespace backlight::models
