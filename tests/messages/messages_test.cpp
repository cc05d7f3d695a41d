// Every bad scene of tests/messages/cases, and the exact text that its author gets.
//
// NAME.toml is read from within that folder, with the overrides of its leading lines "#! -D path=value". What
// is printed must be NAME.txt word for word. With BACKLIGHT_UPDATE_MESSAGES set, the text is written instead
// of compared: read the difference before committing it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "backlight/scene/compile.h"
#include "backlight/scene/reader.h"

namespace backlight {
namespace {

const std::filesystem::path cases_folder =
    std::filesystem::path(BACKLIGHT_SOURCE_DIR) / "tests/messages/cases";

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> overrides_in(const std::string& text) {
  const std::string mark = "#! -D ";
  std::vector<std::string> overrides;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line) && line.starts_with(mark);) {
    overrides.push_back(line.substr(mark.size()));
  }
  return overrides;
}

// What `backlight check NAME.toml` prints about mistakes.
std::string messages_of(const std::string& name) {
  ReadResult result = read_scene(name, overrides_in(contents(name)));
  Diagnostics diagnostics = result.diagnostics;
  if (result.description) {
    ResourceCache cache;
    const bool compiled = compile(*result.description, {}, cache, diagnostics).has_value();
    EXPECT_EQ(compiled, !diagnostics.has_errors());
    diagnostics = in_file_order(diagnostics, *result.description);
  }
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics.all()) text += format(diagnostic) + "\n";
  return text;
}

std::vector<std::string> names_of_cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(cases_folder)) {
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class Messages : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    // So that file names are printed as an author in that folder would see them.
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(cases_folder);
  }
  void TearDown() override { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_;
};

TEST_P(Messages, AreWordForWord) {
  const std::string text = messages_of(GetParam() + ".toml");
  EXPECT_FALSE(text.empty()) << "the scene has nothing wrong";
  if (std::getenv("BACKLIGHT_UPDATE_MESSAGES") != nullptr) {
    std::ofstream(GetParam() + ".txt", std::ios::binary) << text;
    return;
  }
  EXPECT_EQ(text, contents(GetParam() + ".txt"));
}

INSTANTIATE_TEST_SUITE_P(Cases, Messages, testing::ValuesIn(names_of_cases()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace backlight
