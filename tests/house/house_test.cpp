// The tree keeps the rules of docs/architecture.md; and each rule is seen to fail on a bad example.
#include <gtest/gtest.h>

#include <stdexcept>

#include "rules.h"

namespace backlight::house {
namespace {

using Complaints = std::vector<std::string>;

const std::filesystem::path top = BACKLIGHT_SOURCE_DIR;

const RoomTable& table() {
  static const RoomTable parsed = [] {
    const std::vector<SourceFile> files = read_tree(top, {"docs/architecture.md"});
    return parse_room_table(files.at(0).text);
  }();
  return parsed;
}

const std::vector<SourceFile>& code() {
  static const std::vector<SourceFile> files = read_tree(top, {"include", "src"});
  return files;
}

bool is_cpp(const SourceFile& file) {
  return file.path.ends_with(".h") || file.path.ends_with(".cpp");
}

std::string listed(const Complaints& complaints) {
  std::string text;
  for (const std::string& complaint : complaints) text += complaint + "\n";
  return text;
}

TEST(House, EveryIncludeIsAnArrowOfTheRoomTable) {
  std::size_t looked_at = 0;
  for (const SourceFile& file : code()) {
    if (!is_cpp(file)) continue;
    ++looked_at;
    EXPECT_EQ(listed(forbidden_includes(table(), file)), "");
  }
  EXPECT_GT(looked_at, 50u);
}

TEST(House, CMakeOpensNoRoomThatTheTableCloses) {
  std::size_t looked_at = 0;
  for (const SourceFile& file : code()) {
    if (!file.path.ends_with("CMakeLists.txt")) continue;
    ++looked_at;
    EXPECT_EQ(listed(forbidden_links(table(), file)), "");
  }
  EXPECT_EQ(looked_at, table().size());
}

TEST(House, RoomsIncludeOnlyRoomsAboveThemInTheTable) {
  // Every row but app's names rooms of earlier rows, so that the arrows have no circle.
  const std::vector<SourceFile> files = read_tree(top, {"docs/architecture.md"});
  std::map<std::string, std::size_t> row;
  for (const auto& [name, room] : table()) row[name] = files.at(0).text.find("| `" + name + "` |");
  for (const auto& [name, room] : table()) {
    ASSERT_NE(row[name], std::string::npos) << name;
    for (const std::string& other : room.may_include)
      EXPECT_LT(row[other], row[name]) << name << " -> " << other;
  }
}

TEST(House, SlowLibrariesAreIncludedOnce) {
  EXPECT_EQ(listed(repeated_library_includes(code())), "");
}

TEST(House, LongFilesSayWhy) {
  EXPECT_EQ(listed(long_files(code())), "");
  std::vector<SourceFile> tests = read_tree(top, {"tests"});
  std::erase_if(tests, [](const SourceFile& file) { return !is_cpp(file); });
  EXPECT_EQ(listed(long_files(tests)), "");
}

TEST(House, NoQuaternions) {
  EXPECT_EQ(listed(quaternions(code())), "");
}

TEST(House, NoPathsOfOneMachine) {
  const std::vector<SourceFile> files = read_tree(
      top, {"include", "src", "tests", "scripts", "scenes", "docs", "bench", "cmake", "packaging", "python",
            "CMakeLists.txt", "CMakePresets.json", "README.md", "CHANGELOG.md", ".ci/run"});
  EXPECT_GT(files.size(), 100u);
  EXPECT_EQ(listed(machine_paths(files)), "");
}

TEST(House, TheReadmeShowsTheFirstScene) {
  const std::string readme = read_tree(top, {"README.md"}).at(0).text;
  const std::string scene = read_tree(top, {"scenes/first.toml"}).at(0).text;
  EXPECT_NE(readme.find("```toml\n" + scene + "```\n"), std::string::npos);
}

TEST(House, LinksOfTheDocumentationLeadSomewhere) {
  const std::vector<SourceFile> files = read_tree(top, {"README.md", "CHANGELOG.md", "docs", "scenes"});
  EXPECT_GT(files.size(), 5u);
  for (const SourceFile& file : files) {
    if (!file.path.ends_with(".md")) continue;
    EXPECT_EQ(listed(broken_links(top, file)), "");
  }
}

// From here on: bad examples.

const char* const example_table =
    "text | with | bars\n\n"
    "| room | what | may include | libraries |\n| --- | --- | --- | --- |\n"
    "| `base` | x | - | GLM |\n| `middle` | x | base | - |\n| `top` | x | all | OpenEXR, CLI11 |\n\nmore "
    "text\n";

TEST(RoomTable, ReadsTheRows) {
  const RoomTable parsed = parse_room_table(example_table);
  ASSERT_EQ(parsed.size(), 3u);
  EXPECT_TRUE(parsed.at("base").may_include.empty());
  EXPECT_EQ(parsed.at("base").libraries, (std::set<std::string>{"GLM"}));
  EXPECT_EQ(parsed.at("middle").may_include, (std::set<std::string>{"base"}));
  EXPECT_EQ(parsed.at("top").may_include, (std::set<std::string>{"base", "middle"}));
  EXPECT_EQ(parsed.at("top").libraries, (std::set<std::string>{"OpenEXR", "CLI11"}));
}

TEST(RoomTable, RejectsWhatIsNoTable) {
  EXPECT_THROW(parse_room_table("nothing here"), std::runtime_error);
  EXPECT_THROW(parse_room_table("| room | w | may | lib |\n| a | x | attic | - |\n"), std::runtime_error);
  EXPECT_THROW(parse_room_table("| room | w | may | lib |\n| a | x | - | - |\n| a | x | - | - |\n"),
               std::runtime_error);
}

Complaints complaints(const std::string& path, const std::string& text) {
  return forbidden_includes(parse_room_table(example_table), {path, text});
}

TEST(ForbiddenIncludes, AllowsTheArrows) {
  EXPECT_EQ(complaints("src/top/a.cpp",
                       "#include \"backlight/middle/m.h\"\n#include \"helper.h\"\n#include <vector>\n"
                       "#include <sys/stat.h>\n#include <CLI/CLI.hpp>\n"),
            Complaints{});
  EXPECT_EQ(complaints("include/backlight/base/a.h", "#include <glm/vec3.hpp>\n"), Complaints{});
}

TEST(ForbiddenIncludes, FindsEachKindOfBadInclude) {
  EXPECT_EQ(complaints("include/backlight/base/a.h", "//\n#include \"backlight/top/t.h\"\n"),
            Complaints{"include/backlight/base/a.h:2: base may not include top"});
  EXPECT_EQ(complaints("src/middle/a.cpp", "  # include <glm/vec3.hpp>\n"),
            Complaints{"src/middle/a.cpp:1: middle may not use GLM"});
  EXPECT_EQ(complaints("src/middle/a.cpp", "#include \"../base/secret.h\"\n"),
            Complaints{"src/middle/a.cpp:1: \"../base/secret.h\" is private to a room"});
  EXPECT_EQ(complaints("include/backlight/middle/a.h", "#include \"secret.h\"\n"),
            Complaints{"include/backlight/middle/a.h:1: \"secret.h\" is private to a room"});
  EXPECT_EQ(complaints("src/middle/a.cpp", "#include <boost/any.hpp>\n"),
            Complaints{"src/middle/a.cpp:1: boost/any.hpp is of no library in docs/architecture.md"});
  EXPECT_EQ(complaints("src/cellar/a.cpp", ""),
            Complaints{"src/cellar/a.cpp: in no room of docs/architecture.md"});
}

TEST(ForbiddenLinks, FindsARoomTooMany) {
  const RoomTable parsed = parse_room_table(example_table);
  const SourceFile good{"src/middle/CMakeLists.txt",
                        "backlight_room(middle\n  SOURCES a.cpp\n  MAY_INCLUDE base\n  LIBRARIES top)"};
  EXPECT_EQ(forbidden_links(parsed, good), Complaints{});
  const SourceFile bad{"src/middle/CMakeLists.txt",
                       "backlight_room(middle SOURCES a.cpp MAY_INCLUDE base top)"};
  EXPECT_EQ(forbidden_links(parsed, bad),
            Complaints{"src/middle/CMakeLists.txt: middle may not include top"});
}

TEST(RepeatedLibraryIncludes, FindsTheSecondFile) {
  const SourceFile first{"src/app/a.cpp", "#include <CLI/CLI.hpp>\n"};
  const SourceFile second{"src/app/b.cpp", "#include <CLI/App.hpp>\n"};
  EXPECT_EQ(repeated_library_includes({first}), Complaints{});
  EXPECT_EQ(repeated_library_includes({first, second}),
            Complaints{"CLI11 is included in more than one file: src/app/a.cpp src/app/b.cpp"});
}

TEST(LongFiles, WantsAReason) {
  const std::string lines(401, '\n');
  EXPECT_EQ(long_files({{"a.cpp", lines}}), Complaints{"a.cpp: 401 lines and no reason"});
  EXPECT_EQ(long_files({{"a.cpp", "// Longer than 400 lines: a table." + lines}}), Complaints{});
  EXPECT_EQ(long_files({{"a.cpp", std::string(400, '\n')}}), Complaints{});
}

TEST(Quaternions, AreFound) {
  EXPECT_EQ(quaternions({{"a.cpp",
                          "x\nglm::d"
                          "quat q;\n"}}),
            Complaints{"a.cpp:2: GLM's quaternions"});
  EXPECT_EQ(quaternions({{"a.cpp", "#include <glm/gtc/quaternion.hpp>\n"}}).size(), 1u);
}

TEST(BrokenLinks, AreFound) {
  const SourceFile page{"docs/page.md",
                        "[a](../README.md) [b](gone.md#part) ![c](x/y.png)\n[d](https://e.f/g)"};
  EXPECT_EQ(broken_links(top, page), (Complaints{"docs/page.md: no gone.md", "docs/page.md: no x/y.png"}));
}

TEST(MachinePaths, AreFound) {
  const std::string home = std::string("/") + "home/someone";
  EXPECT_EQ(machine_paths({{"a.sh", "x\ncd " + home + "\n"}}), Complaints{"a.sh:2: a path of one machine"});
  EXPECT_EQ(machine_paths({{"a.sh", "cd $top/build/x; cd ../build/x; ls tests/work/a\n"}}), Complaints{});
}

}  // namespace
}  // namespace backlight::house
