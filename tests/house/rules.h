// The rules of docs/architecture.md that a program can check, and the files they are about.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace backlight::house {

/// One row of the room table in docs/architecture.md.
struct Room {
  std::set<std::string> may_include;  ///< other rooms
  std::set<std::string> libraries;    ///< other people's headers: "GLM", "OpenEXR", ...
};

using RoomTable = std::map<std::string, Room>;

/// The room table of a Markdown text: the rows of the table whose first column is headed "room". A cell "all"
/// stands for every other room. Throws std::runtime_error where there is no such table or a row is unclear.
RoomTable parse_room_table(std::string_view markdown);

/// A file of the tree, with its path from the top of the tree, written with slashes.
struct SourceFile {
  std::string path;
  std::string text;
};

/// The text files under these folders or files of the tree, in the order of their paths.
std::vector<SourceFile> read_tree(const std::filesystem::path& top, const std::vector<std::string>& folders);

/// The #include lines of one file of include/ or src/ that the table does not allow: one "path:line: ..."
/// each.
std::vector<std::string> forbidden_includes(const RoomTable& table, const SourceFile& file);

/// Rooms that MAY_INCLUDE of a src/<room>/CMakeLists.txt opens although the table does not.
std::vector<std::string> forbidden_links(const RoomTable& table, const SourceFile& cmake_file);

/// Library headers that are to be included in one file only (they are slow to compile or to load), but are in
/// more of `files`.
std::vector<std::string> repeated_library_includes(const std::vector<SourceFile>& files);

/// Files of more than 400 lines without a line "// Longer than 400 lines: <reason>".
std::vector<std::string> long_files(const std::vector<SourceFile>& files);

/// Uses of GLM's quaternions, whose constructor takes its arguments in an order that changed between
/// versions.
std::vector<std::string> quaternions(const std::vector<SourceFile>& files);

/// Paths that only one machine has: home and work folders.
std::vector<std::string> machine_paths(const std::vector<SourceFile>& files);

/// Relative links of a Markdown file, "[text](target)", to files that are not there.
std::vector<std::string> broken_links(const std::filesystem::path& top, const SourceFile& markdown);

}  // namespace backlight::house
