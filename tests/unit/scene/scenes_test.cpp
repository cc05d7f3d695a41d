// The scenes that come with the program have nothing wrong, at any frame of theirs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "backlight/scene/compile.h"
#include "backlight/scene/explain.h"
#include "compiled.h"

namespace backlight {
namespace {

std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(BACKLIGHT_SOURCE_DIR) + "/scenes")) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

class ShippedScenes : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(ShippedScenes, HaveNothingWrong) {
  ReadResult read = read_scene(GetParam());
  ASSERT_TRUE(read.description.has_value()) << testing_scenes::all_messages(read.diagnostics);
  const std::vector<int> frames = animation_frames(*read.description);
  ASSERT_FALSE(frames.empty());
  ResourceCache cache;
  for (const int frame : {frames.front(), frames[frames.size() / 2], frames.back()}) {
    ImageRequest request;
    request.frame = frame;
    const auto scene = compile(*read.description, request, cache, read.diagnostics);
    ASSERT_TRUE(scene.has_value()) << "frame " << frame << "\n"
                                   << testing_scenes::all_messages(read.diagnostics);
    EXPECT_FALSE(explain(*read.description, *scene, needs_of(*scene)).empty());
  }
  EXPECT_TRUE(read.diagnostics.all().empty()) << testing_scenes::all_messages(read.diagnostics);
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScenes, testing::ValuesIn(shipped_scenes()), [](const auto& test) {
  std::string name = test.param.stem().string();
  std::replace_if(
      name.begin(), name.end(), [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace backlight
