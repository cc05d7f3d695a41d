#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {

void check_ply_header(const std::string& path) {
  constexpr std::size_t longest_header = 1 << 16;
  std::ifstream file(path, std::ios::binary);
  std::string header(longest_header, '\0');
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  header.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t end = header.find("end_header");
  if (!header.starts_with("ply") || end == std::string::npos)
    throw std::runtime_error("it has no header of a PLY file");
  const std::uint64_t bytes = std::filesystem::file_size(path);
  std::istringstream lines(header.substr(0, end));
  std::uint64_t announced = 0;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string word, name;
    std::uint64_t count = 0;
    if (!(words >> word) || word != "element") continue;
    if (!(words >> name >> count)) throw std::runtime_error("its header is damaged: " + line);
    announced += count;
    // No element takes less than a byte.
    if (count > bytes || announced > bytes) {
      throw std::runtime_error("it says that it has " + std::to_string(count) + " of '" + name +
                               "', and has " + std::to_string(bytes) + " bytes");
    }
  }
}

}  // namespace backlight::models
