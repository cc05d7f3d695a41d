// backlight compare: verdicts, exit codes, folders, --update, and agreement with idiff.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <random>

#include "backlight/film/exr.h"
#include "program.h"

namespace backlight::test {
namespace {

using Strings = std::vector<std::string>;

class Compare : public ProgramTest {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder / "work" / name).string(); }

  // An RGB picture of 10 x 10 zeros with these values in channel R, from the top left.
  void picture(const std::string& name, const std::vector<float>& values) const {
    ImageLayout layout;
    layout.display = layout.data = {0, 0, 10, 10};
    layout.channels = {
        {"R", ChannelPrecision::single}, {"G", ChannelPrecision::single}, {"B", ChannelPrecision::single}};
    Image image(layout);
    std::copy(values.begin(), values.end(), image.plane(0).begin());
    std::filesystem::create_directories((folder / "work" / name).parent_path());
    const auto written = write_exr(path(name), image, {});
    if (!written.ok()) ADD_FAILURE() << written.error();
  }

  void expect(int code, const Strings& arguments, const Strings& in_output) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    for (const std::string& text : in_output) {
      EXPECT_NE((outcome.out + outcome.err).find(text), std::string::npos) << "no '" << text << "' in:\n"
                                                                           << outcome.out << outcome.err;
    }
  }
};

TEST_F(Compare, TellsEqualFromDifferent) {
  picture("a.exr", {1.0F});
  picture("b.exr", {1.0F, 0.25F});
  expect(0, {"compare", "a.exr", "a.exr"}, {"a.exr: equal"});
  expect(1, {"compare", "a.exr", "b.exr"},
         {"b.exr: differs: 1 pixel (1 %) over the threshold, worst R by 0.25 at 1,0"});
  expect(0, {"compare", "a.exr", "b.exr", "--fail", "0.25"}, {"b.exr: warning"});
  expect(0, {"compare", "a.exr", "b.exr", "--tolerance", "G=0", "--tolerance", "R=0.3"}, {"b.exr: equal"});
  expect(1, {"compare", "a.exr", "b.exr", "--tolerance", "R=0.3", "--tolerance", "R=0.2"}, {});
  expect(0, {"compare", "a.exr", "b.exr", "--channels", "G,B"}, {"b.exr: equal"});
  const Outcome quiet = run({"compare", "-q", "a.exr", "b.exr"});
  EXPECT_EQ(quiet.code, 1);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(Compare, ReportsNaN) {
  picture("a.exr", {1.0F});
  picture("b.exr", {std::numeric_limits<float>::quiet_NaN()});
  expect(
      1, {"compare", "a.exr", "b.exr", "--fail", "1e9"},
      {"worst R by inf at 0,0", "NaN: 0 in the reference, 1 in the new image; 1 of them on one side only"});
  expect(0, {"compare", "b.exr", "b.exr"}, {"NaN: 1 in the reference, 1 in the new image"});
}

TEST_F(Compare, ExitsWith2WhenItCannotTell) {
  picture("a.exr", {1.0F});
  const std::string whole = read("a.exr");
  write("cut.exr", whole.substr(0, whole.size() - 20));
  write("text.exr", "no picture");
  std::filesystem::create_directories(folder / "work" / "empty");
  expect(2, {"compare", "a.exr", "cut.exr"}, {"cut.exr", "the file ends too early"});
  expect(2, {"compare", "text.exr", "a.exr"}, {"it is not an OpenEXR file"});
  expect(2, {"compare", "a.exr", "gone.exr"}, {"cannot read gone.exr: No such file or directory"});
  expect(2, {"compare", "a.exr", "empty"}, {"a folder can only be compared with a folder: a.exr is a file"});
  expect(2, {"compare", "empty", "empty"}, {"there is no .exr file in empty"});
  expect(2, {"compare", "a.exr", "a.exr", "--tolerance", "Z=1"},
         {"there is no channel 'Z'; there are B, G, R"});
  expect(2, {"compare", "a.exr"}, {"two images or two folders are needed"});
  expect(2, {"compare", "a.exr", "a.exr", "--tolerance", "Z"}, {"expected channel=number, such as Z=1e-6"});
  expect(2, {"compare", "a.exr", "a.exr", "--fail", "-1"}, {"expected a number of at least 0, not '-1'"});
}

TEST_F(Compare, GoesThroughFolders) {
  picture("ref/a.exr", {1.0F});
  picture("ref/sub/b.exr", {1.0F});
  picture("new/a.exr", {1.0F});
  picture("new/sub/b.exr", {1.0F});
  expect(0, {"compare", "ref", "new"}, {"a.exr: equal", "sub/b.exr: equal", "2 images, 2 equal"});
  picture("new/sub/b.exr", {2.0F});
  picture("ref/gone.exr", {1.0F});
  picture("new/more.exr", {1.0F});
  picture("new/.hidden.exr", {1.0F});
  expect(1, {"compare", "ref", "new"},
         {"gone.exr: missing", "more.exr: extra", "sub/b.exr: differs",
          "4 images, 1 equal, 1 differs, 1 missing, 1 extra"});
  write("new/broken.exr", "no picture");
  expect(2, {"compare", "ref", "new"}, {"broken.exr: cannot read", "sub/b.exr: differs"});
}

TEST_F(Compare, UpdatesOnlyWhatDiffers) {
  picture("ref/same.exr", {1.0F});
  picture("ref/close.exr", {1.0F});
  picture("ref/other.exr", {1.0F});
  picture("ref/gone.exr", {1.0F});
  picture("new/same.exr", {1.0F});
  picture("new/close.exr", {1.01F});
  picture("new/other.exr", {2.0F});
  picture("new/more/deep.exr", {1.0F});
  const std::string close = read("ref/close.exr");
  const std::string gone = read("ref/gone.exr");
  const Outcome outcome = run({"compare", "ref", "new", "--fail", "0.1", "-q", "--update"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;  // one is missing still
  EXPECT_EQ(outcome.out, "updated ref/more/deep.exr\nupdated ref/other.exr\n");
  EXPECT_EQ(read("ref/other.exr"), read("new/other.exr"));
  EXPECT_EQ(read("ref/more/deep.exr"), read("new/more/deep.exr"));
  EXPECT_EQ(read("ref/close.exr"), close);
  EXPECT_EQ(read("ref/gone.exr"), gone);
  std::filesystem::remove(folder / "work" / "ref" / "gone.exr");
  expect(0, {"compare", "ref", "new", "--fail", "0.1"}, {});
  // A damaged new image never becomes a reference.
  write("new/other.exr", "no picture");
  expect(2, {"compare", "ref", "new", "--update"}, {"cannot read new/other.exr"});
  EXPECT_NE(read("ref/other.exr"), "no picture");
  // A first run: there are no references yet.
  expect(0, {"compare", "none", "ref", "--update"}, {"updated none/other.exr"});
  expect(0, {"compare", "none", "ref"}, {});
}

TEST_F(Compare, TellsHowToRenderThePixelAgain) {
  write_scene("scene.toml", "[animation]\nfps = 10\nframes = [1, 3]\n");
  ASSERT_EQ(run({"scene.toml", "-f", "2", "-s", "3", "--seed", "5", "--aov", "Z,P", "-D", "camera.fov=41",
                 "-r", "24x16", "-o", "ref.exr"})
                .code,
            0);
  ASSERT_EQ(run({"scene.toml", "-f", "2", "-s", "3", "--seed", "5", "--aov", "Z,P", "-D", "camera.fov=40",
                 "-r", "24x16", "-o", "new.exr"})
                .code,
            0);
  expect(1, {"compare", "ref.0002.exr", "new.0002.exr", "--html", "report.html"}, {});
  const std::string report = read("report.html");
  const std::string command =
      "backlight render scene.toml -D camera.fov=40 -f 2 -r 24x16 -s 3 --seed 5 --aov P,Z";
  EXPECT_NE(report.find("\"again\":\"" + command + "\""), std::string::npos);
  expect(1, {"compare", "ref.0002.exr", "new.0002.exr", "--html", "far.html", "--scenes", "../shots"}, {});
  EXPECT_NE(read("far.html").find("backlight render ../shots/scene.toml -D"), std::string::npos);
  expect(0,
         {"render", "scene.toml", "-D", "camera.fov=40", "-f", "2", "-r", "24x16", "-s", "3", "--seed", "5",
          "--aov", "P,Z", "-o", "whole.exr"},
         {});
  EXPECT_EQ(read("whole.0002.exr"), read("new.0002.exr"));
  // Nothing is fetched from elsewhere.
  for (const char* address : {"http:", "https:", "src=\"/", "@import", "url("}) {
    std::size_t found = report.find(address);
    if (std::string(address) == "http:") {
      EXPECT_EQ(report.substr(found, 26), "http://www.w3.org/2000/svg") << "the name of SVG";
      found = report.find(address, found + 1);
    }
    EXPECT_EQ(found, std::string::npos) << address;
  }
}

// idiff (package openimageio-tools), where it is installed: its verdicts on random pictures and limits.
TEST_F(Compare, AgreesWithIdiff) {
  if (std::system("idiff --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "idiff is not installed";
  std::mt19937 random(7);
  std::uniform_real_distribution<float> value(0.1F, 2.0F);
  int failures = 0;
  const Strings limits[] = {{},
                            {"fail", "0.01"},
                            {"fail", "0.01", "failpercent", "3"},
                            {"fail", "0.001", "hardfail", "0.05", "failpercent", "50"},
                            {"failrelative", "0.02"},
                            {"fail", "0.01", "failrelative", "0.02", "allowfailures", "2"},
                            {"fail", "0.01", "allowfailures", "3", "hardfail", "0.011"}};
  // idiff takes most of a second to start.
  for (int round = 0; round < 2; ++round) {
    std::vector<float> a(100);
    for (float& one : a) one = value(random);
    std::vector<float> b = a;
    for (int i = 0; i < 2 + 2 * round; ++i) b[random() % 100] += 0.02F * (value(random) - 1.0F);
    picture("a.exr", a);
    picture("b.exr", b);
    for (const Strings& limit : limits) {
      Strings ours{"compare", "-q", "a.exr", "b.exr"};
      std::string theirs = "idiff -q";
      for (std::size_t i = 0; i < limit.size(); i += 2) {
        ours.insert(ours.end(), {"--" + limit[i], limit[i + 1]});
        theirs += " -" + limit[i] + " " + limit[i + 1];
      }
      theirs += " '" + path("a.exr") + "' '" + path("b.exr") + "' >/dev/null";
      const int idiff = WEXITSTATUS(std::system(theirs.c_str()));  // 0 equal, 1 warning, 2 failure
      EXPECT_EQ(run(ours).code, idiff == 2 ? 1 : 0) << theirs;
      failures += idiff == 2 ? 1 : 0;
    }
  }
  EXPECT_GT(failures, 2);
  EXPECT_LT(failures, 12);
}

}  // namespace
}  // namespace backlight::test
