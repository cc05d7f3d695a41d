// Help, and what is said about wrong command lines, word for word.
#include <algorithm>
#include <sstream>

#include "program.h"

namespace backlight::test {
namespace {

using Usage = ProgramTest;

TEST_F(Usage, HelpGoesToStandardOutput) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"-h"},
                                                    {"help"},
                                                    {"render", "--help"},
                                                    {"check", "-h"},
                                                    {"view", "--help"},
                                                    {"info", "--help"},
                                                    {"probe", "--help"},
                                                    {"schema", "--help"},
                                                    {"help", "view"},
                                                    {"scene.toml", "--help"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << arguments[0];
    EXPECT_NE(outcome.out.find("Usage: backlight"), std::string::npos) << arguments[0];
    EXPECT_EQ(outcome.err, "") << arguments[0];
  }
}

TEST_F(Usage, HelpFitsTheTerminalAndNamesEveryOption) {
  const std::string help = run({"render", "--help"}).out;
  for (const char* option : {"-o, --output PATTERN",
                             "-f, --frames RANGE",
                             "--time T",
                             "-r, --resolution WxH",
                             "--crop X0,Y0,X1,Y1",
                             "-s, --samples N",
                             "--seed N",
                             "-t, --threads N",
                             "-D, --set PATH=VALUE",
                             "--camera NAME",
                             "--aov LIST",
                             "--half",
                             "--float",
                             "--png",
                             "--progress STYLE",
                             "-q, --quiet",
                             "-v, --verbose",
                             "--stats FILE",
                             "--dry-run",
                             "--list-frames",
                             "-h, --help"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  EXPECT_EQ(help.find("\n\n\n"), std::string::npos);
}

TEST_F(Usage, VersionIsOneLine) {
  const Outcome outcome = run({"--version"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out.find("Backlight "), 0U);
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 1);
}

struct WrongLine {
  std::vector<std::string> arguments;
  std::string message;  ///< of the first line
  std::string help;     ///< of the second
};

TEST_F(Usage, WrongLinesAreExplained) {
  write_scene();
  const std::string render = "backlight render --help";
  const std::vector<WrongLine> lines{
      {{}, "no scene file is given", "backlight --help"},
      {{"render"}, "no scene file is given", render},
      {{"-q"}, "no scene file is given", render},
      {{"rendr", "scene.toml"},
       "there is neither a command nor a file called 'rendr'; did you mean 'render'?",
       "backlight --help"},
      {{"frobnicate"}, "there is neither a command nor a file called 'frobnicate'", "backlight --help"},
      {{"scene.toml", "other.toml"}, "more than one scene file is given: 'other.toml'", render},
      {{"scene.toml", "--sampels", "4"}, "unknown option '--sampels'; did you mean '--samples'?", render},
      {{"scene.toml", "--frmes=4"}, "unknown option '--frmes'; did you mean '--frames'?", render},
      {{"scene.toml", "-z"}, "unknown option '-z'", render},
      {{"--resoluton", "4x4", "scene.toml"},
       "unknown option '--resoluton'; did you mean '--resolution'?",
       render},
      {{"--sampels", "4", "render", "scene.toml"},
       "unknown option '--sampels'; did you mean '--samples'?",
       render},
      {{"-q", "-z", "4", "scene.toml"}, "unknown option '-z'", render},
      {{"--fial", "3", "compare", "a.exr", "b.exr"},
       "unknown option '--fial'; did you mean '--fail'?",
       "backlight compare --help"},
      {{"--tonne", "log", "view", "a.exr"},
       "unknown option '--tonne'; did you mean '--tone'?",
       "backlight view --help"},
      {{"check", "--camra", "left", "scene.toml"},
       "unknown option '--camra'; did you mean '--camera'?",
       "backlight check --help"},
      {{"-s", "4", "4x4", "scene.toml"},
       "there is neither a command nor a file called '4x4'",
       "backlight --help"},
      {{"scene.toml", "--columns", "2"}, "'--columns' is an option of 'backlight view'", render},
      {{"view", "a.exr", "--samples", "2"},
       "'--samples' is an option of 'backlight render'",
       "backlight view --help"},
      {{"check", "scene.toml", "-f", "3"},
       "'-f' is an option of 'backlight render'",
       "backlight check --help"},
      {{"scene.toml", "-s"}, "--samples needs a value", render},
      {{"scene.toml", "-s", "0"}, "--samples: expected a whole number from 1 to 1048576, not '0'", render},
      {{"scene.toml", "-s", "many"},
       "--samples: expected a whole number from 1 to 1048576, not 'many'",
       render},
      {{"scene.toml", "-t", "-1"}, "--threads: expected a whole number from 1 to 65536, not '-1'", render},
      {{"scene.toml", "--seed", "-1"},
       "--seed: expected a whole number from 0 to 4294967295, not '-1'",
       render},
      {{"scene.toml", "-r", "1280"},
       "--resolution: expected WIDTHxHEIGHT, such as 1280x720 (up to 65536x65536), not '1280'",
       render},
      {{"scene.toml", "-r", "0x720"},
       "--resolution: expected WIDTHxHEIGHT, such as 1280x720 (up to 65536x65536), not '0x720'",
       render},
      {{"scene.toml", "--crop", "0,0,10"},
       "--crop: expected x0,y0,x1,y1 in pixels, such as 0,0,640,360, not '0,0,10'",
       render},
      {{"scene.toml", "--crop", "9,0,9,5"},
       "--crop: the crop '9,0,9,5' is empty: x1 must be above x0, and y1 above y0",
       render},
      {{"scene.toml", "-f", "1:5"},
       "--frames: '1:5' is not a range of frames: write 7, 1-100 or 1-100x2, with commas between several",
       render},
      {{"scene.toml", "-f", "5-1"}, "--frames: the range '5-1' runs backwards", render},
      {{"scene.toml", "--time", "soon"}, "--time: expected a number, not 'soon'", render},
      {{"scene.toml", "--time", "1", "-f", "2"}, "--time: not together with --frames", render},
      {{"scene.toml", "--half", "--float"}, "--half: not together with --float", render},
      {{"scene.toml", "-q", "-v"}, "--quiet: not together with --verbose", render},
      {{"scene.toml", "-D", "camera"},
       "--set: expected path=value, such as camera.fov=40, not 'camera'",
       render},
      {{"scene.toml", "--progress", "barr"},
       "--progress: expected one of auto, bar, lines, json, none, not 'barr'; did you mean 'bar'?",
       render},
      {{"scene.toml", "--aov", "Z,dopler"},
       "--aov: expected one of Z, doppler, emissionTime, properTime, P, N, objectId, unresolved, light, "
       "samples, mirror, lampTime, not "
       "'dopler'; did you mean 'doppler'?",
       render},
      {{"scene.toml", "-o", ""}, "--output: the name of the output file is empty", render},
      {{"scene.toml", "-o", "a%s.exr"},
       "--output: 'a%s.exr': after % comes 04d (or another width), or % for a percent sign",
       render},
      {{"view"}, "no image file is given", "backlight view --help"},
      {{"view", "a.exr", "b.exr"},
       "several images make one contact sheet: name it with -o",
       "backlight view --help"},
      {{"view", "a.exr", "--white", "0"},
       "--white: expected a number greater than 0",
       "backlight view --help"},
      {{"info"}, "no image file is given", "backlight info --help"},
      {{"schema", "more"}, "unexpected argument 'more'", "backlight schema --help"},
  };
  for (const WrongLine& line : lines) {
    const Outcome outcome = run(line.arguments);
    EXPECT_EQ(outcome.code, 2) << line.message;
    EXPECT_EQ(outcome.err, "backlight: " + line.message + "\nTry '" + line.help + "'.\n");
    EXPECT_EQ(outcome.out, "") << line.message;
  }
  EXPECT_EQ(files(), std::vector<std::string>{"scene.toml"});
}

TEST_F(Usage, OutputMustBeAnExr) {
  write_scene();
  const Outcome png = run({"scene.toml", "-o", "a.png"});
  EXPECT_EQ(png.code, 2);
  EXPECT_EQ(png.err,
            "backlight: error: --output: images are written as OpenEXR: 'a.png' must end in .exr, or in / "
            "for a folder "
            "(--png writes a PNG beside the EXR)\n");
  EXPECT_EQ(run({"scene.toml", "-o", "a"}).code, 2);
}

TEST_F(Usage, ViewNeverWritesOverAnImage) {
  write("a.exr", "precious");
  const Outcome outcome = run({"view", "b.exr", "-o", "a.exr"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err,
            "backlight: error: --output: a view is written as PNG: 'a.exr' must end in .png, or in / for a "
            "folder\n");
  EXPECT_EQ(read("a.exr"), "precious");
}

TEST_F(Usage, CropMustBeInsideTheImage) {
  write_scene();
  const Outcome outcome = run({"scene.toml", "--crop", "0,0,33,20"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.err, "backlight: error: --crop: reaches beyond the image, which is 32x20\n");
}

TEST_F(Usage, OrderOfFlagsDoesNotMatter) {
  write_scene();
  const std::string first = run({"render", "scene.toml", "-f", "1-3", "-o", "a.exr", "--dry-run"}).out;
  EXPECT_EQ(first, "a.0001.exr\na.0002.exr\na.0003.exr\n");
  EXPECT_EQ(run({"--dry-run", "-o", "a.exr", "-f", "1-3", "render", "scene.toml"}).out, first);
  EXPECT_EQ(run({"-o", "a.exr", "scene.toml", "--dry-run", "-f1-3"}).out, first);
  EXPECT_EQ(run({"--output=a.exr", "--frames=1-3", "--dry-run", "--", "scene.toml"}).out, first);
}

}  // namespace
}  // namespace backlight::test
