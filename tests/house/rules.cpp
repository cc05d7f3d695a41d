#include "rules.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace backlight::house {
namespace {

struct Library {
  std::string_view name;            // as the room table says it
  std::string_view include_prefix;  // what its headers begin with
  bool in_one_file;
};

constexpr std::array<Library, 10> libraries{{{"GLM", "glm/", false},
                                             {"OpenEXR", "OpenEXR/", false},
                                             {"OpenEXR", "Imath/", false},
                                             {"OpenImageIO", "OpenImageIO/", true},
                                             {"tinyobjloader", "tiny_obj_loader.h", true},
                                             {"FreeType", "freetype/", true},
                                             {"fontconfig", "fontconfig/", true},
                                             {"toml++", "toml++/", false},
                                             {"CLI11", "CLI/", true},
                                             {"nlohmann", "nlohmann/", true}}};

const Library* library_of(std::string_view header) {
  const auto* found = std::find_if(libraries.begin(), libraries.end(),
                                   [&](const Library& l) { return header.starts_with(l.include_prefix); });
  return found == libraries.end() ? nullptr : found;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t`");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t`") - first + 1));
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    parts.push_back(trimmed(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

std::set<std::string> names(const std::string& cell) {
  if (cell.empty() || cell == "-") return {};
  const std::vector<std::string> parts = split(cell, ',');
  return {parts.begin(), parts.end()};
}

struct Include {
  int line;
  bool quoted;
  std::string header;
};

std::vector<Include> includes(const std::string& text) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (std::regex_match(line, match, pattern)) found.push_back({number, match[1] == "\"", match[2]});
  }
  return found;
}

std::string at(const SourceFile& file, int line) {
  return file.path + ":" + std::to_string(line) + ": ";
}

// The room of "src/<room>/..." or "include/backlight/<room>/...", or empty.
std::string room_of(const std::string& path) {
  for (const std::string_view folder : {"src/", "include/backlight/"}) {
    if (path.starts_with(folder))
      return path.substr(folder.size(), path.find('/', folder.size()) - folder.size());
  }
  return {};
}

std::vector<std::string> lines_with(const std::vector<SourceFile>& files, const std::regex& pattern,
                                    const std::string& complaint) {
  std::vector<std::string> found;
  for (const SourceFile& file : files) {
    std::istringstream lines(file.text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
      if (std::regex_search(line, pattern)) found.push_back(at(file, number) + complaint);
    }
  }
  return found;
}

}  // namespace

RoomTable parse_room_table(std::string_view markdown) {
  RoomTable table;
  bool inside = false;
  for (const std::string& line : split(markdown, '\n')) {
    const std::vector<std::string> cells = split(line, '|');  // "| a | b |" has empty first and last cells
    if (cells.size() != 6) {
      inside = false;
    } else if (cells[1] == "room") {
      inside = true;
    } else if (inside && !cells[1].starts_with("---")) {
      if (table.contains(cells[1])) throw std::runtime_error("two rows for room " + cells[1]);
      table[cells[1]] = {names(cells[3]), names(cells[4])};
    }
  }
  if (table.empty()) throw std::runtime_error("no room table");
  for (auto& [name, room] : table) {
    if (room.may_include.erase("all")) {
      for (const auto& [other, unused] : table) room.may_include.insert(other);
      room.may_include.erase(name);
    }
    for (const std::string& other : room.may_include) {
      if (!table.contains(other))
        throw std::runtime_error(name + " may include " + other + ", which is no room");
    }
  }
  return table;
}

std::vector<SourceFile> read_tree(const std::filesystem::path& top, const std::vector<std::string>& folders) {
  static const std::set<std::string> endings{".h",  ".cpp",  ".cmake", ".txt", ".md",
                                             ".sh", ".toml", ".py",    ".json"};
  std::vector<SourceFile> files;
  const auto read = [&](const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    files.push_back(
        {path.lexically_relative(top).generic_string(), {std::istreambuf_iterator<char>(stream), {}}});
  };
  for (const std::string& folder : folders) {
    if (std::filesystem::is_regular_file(top / folder)) read(top / folder);
    if (!std::filesystem::is_directory(top / folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(top / folder)) {
      if (entry.is_regular_file() && endings.contains(entry.path().extension().string())) read(entry.path());
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> forbidden_includes(const RoomTable& table, const SourceFile& file) {
  const std::string name = room_of(file.path);
  if (!table.contains(name)) return {file.path + ": in no room of docs/architecture.md"};
  const Room& room = table.at(name);
  std::vector<std::string> found;
  for (const Include& include : includes(file.text)) {
    const std::string place = at(file, include.line);
    if (!include.quoted) {
      const Library* library = library_of(include.header);
      if (library && !room.libraries.contains(std::string(library->name))) {
        found.push_back(place + name + " may not use " + std::string(library->name));
      } else if (!library && include.header.find('/') != std::string::npos &&
                 !include.header.starts_with("sys/")) {
        found.push_back(place + include.header + " is of no library in docs/architecture.md");
      }
    } else if (include.header.starts_with("backlight/")) {
      const std::string other = room_of("include/" + include.header);
      if (other != name && !room.may_include.contains(other)) {
        found.push_back(place + name + " may not include " + other);
      }
    } else if (include.header.find("..") != std::string::npos || !file.path.starts_with("src/")) {
      found.push_back(place + "\"" + include.header + "\" is private to a room");
    }
  }
  return found;
}

std::vector<std::string> forbidden_links(const RoomTable& table, const SourceFile& cmake_file) {
  static const std::regex call(R"(backlight_room\(\s*(\w+)([^)]*)\))");
  static const std::regex list(R"(MAY_INCLUDE((\s+[a-z_]+)*))");
  std::vector<std::string> found;
  std::smatch room, rooms;
  if (!std::regex_search(cmake_file.text, room, call)) return found;
  const std::string arguments = room[2];
  if (!table.contains(room[1])) return {cmake_file.path + ": no room " + room[1].str() + " in the table"};
  if (!std::regex_search(arguments, rooms, list)) return found;
  std::istringstream words(rooms[1]);
  for (std::string other; words >> other;) {
    if (!table.at(room[1]).may_include.contains(other)) {
      found.push_back(cmake_file.path + ": " + room[1].str() + " may not include " + other);
    }
  }
  return found;
}

std::vector<std::string> repeated_library_includes(const std::vector<SourceFile>& files) {
  std::map<std::string, std::set<std::string>> users;
  for (const SourceFile& file : files) {
    for (const Include& include : includes(file.text)) {
      const Library* library = library_of(include.header);
      if (library && library->in_one_file) users[std::string(library->name)].insert(file.path);
    }
  }
  std::vector<std::string> found;
  for (const auto& [library, paths] : users) {
    if (paths.size() == 1) continue;
    std::string complaint = library + " is included in more than one file:";
    for (const std::string& path : paths) complaint += " " + path;
    found.push_back(complaint);
  }
  return found;
}

std::vector<std::string> long_files(const std::vector<SourceFile>& files) {
  std::vector<std::string> found;
  for (const SourceFile& file : files) {
    const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
    if (lines > 400 && file.text.find("// Longer than 400 lines: ") == std::string::npos) {
      found.push_back(file.path + ": " + std::to_string(lines) + " lines and no reason");
    }
  }
  return found;
}

std::vector<std::string> quaternions(const std::vector<SourceFile>& files) {
  return lines_with(files, std::regex("glm::[a-z]*quat|glm/.*quaternion"), "GLM's quaternions");
}

std::vector<std::string> machine_paths(const std::vector<SourceFile>& files) {
  return lines_with(files, std::regex("(^|[^\\w./$}~*])/(home|root|work|tmp|Users)/"),
                    "a path of one machine");
}

std::vector<std::string> broken_links(const std::filesystem::path& top, const SourceFile& markdown) {
  static const std::regex link(R"(\]\(([^)#\s]+)[^)]*\))");
  const std::filesystem::path folder = (top / markdown.path).parent_path();
  std::vector<std::string> found;
  for (std::sregex_iterator match(markdown.text.begin(), markdown.text.end(), link), end; match != end;
       ++match) {
    const std::string target = (*match)[1];
    if (target.find("://") != std::string::npos || std::filesystem::exists(folder / target)) continue;
    found.push_back(markdown.path + ": no " + target);
  }
  return found;
}

}  // namespace backlight::house
