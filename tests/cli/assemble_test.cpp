// An image rendered in parts and put together again has the bytes of the image rendered as a whole.
#include <filesystem>

#include "program.h"

namespace backlight::test {
namespace {

class Assemble : public ProgramTest {
 protected:
  // Colour, depth, stars and lamp light, seen by a camera at 0.6 c.
  void write_picture(const std::string& camera = "", const std::string& radiance = "2") const {
    write("scene.toml",
          "[film]\nresolution = [75, 53]\nsamples = 2\naovs = [\"Z\", \"doppler\", \"P\", \"N\", "
          "\"objectId\"]\n"
          "[camera]\nposition = [0, 1, -7]\ndirection = [0, -0.1, 1]\nbeta = [0.2, 0, 0.56]\n" +
              camera +
              "[background]\ncolor = [0.1, 0.2, 0.4]\nstars = { count = 300, seed = 4 }\n"
              "[[light]]\nposition = [-4, 6, -6]\nintensity = 300\n"
              "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [-1, 0, 1]\nbeta = [0.3, 0, 0.3]\n"
              "[[object]]\nshape = \"box\"\nsize = [1, 1, 1]\nposition = [2, 0, 0]\n"
              "material = { emission = " +
              radiance + " }\n");
  }

  void render(const std::string& output, const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"scene.toml", "-q", "-o", output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }

  // Four parts whose edges lie on no tile and on no chunk of the file, in `a.exr` ... `d.exr`.
  void render_parts(std::vector<std::string> options = {}) {
    const std::vector<std::pair<std::string, std::string>> parts{
        {"a.exr", "0,0,31,29"}, {"b.exr", "31,0,75,29"}, {"c.exr", "0,29,75,30"}, {"d.exr", "0,30,75,53"}};
    options.insert(options.end(), {"--crop", ""});
    for (const auto& [file, crop] : parts) {
      options.back() = crop;
      render(file, options);
    }
  }

  Outcome assemble(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "assemble");
    return run(arguments);
  }

  void expect_whole(const std::vector<std::string>& whole_options, std::vector<std::string> options = {}) {
    render("whole.exr", whole_options);
    options.insert(options.end(), {"d.exr", "b.exr", "a.exr", "c.exr", "-o", "out/put.together.exr"});
    const Outcome outcome = assemble(options);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err + outcome.out, "");
    EXPECT_GT(read("whole.exr").size(), 20000U);
    EXPECT_TRUE(read("whole.exr") == read("out/put.together.exr"));
  }

  void expect_misfit(const std::vector<std::string>& arguments, const std::string& message) {
    const Outcome outcome = assemble(arguments);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err, "backlight: error: " + message + "\n");
    EXPECT_FALSE(exists("out.exr"));
  }
};

TEST_F(Assemble, GivesTheBytesOfTheWholeImage) {
  write_picture();
  render_parts();
  expect_whole({});
}

TEST_F(Assemble, GivesTheBytesOfAStereoPair) {
  write_picture("stereo = { separation = 0.3 }\n");
  render_parts();
  expect_whole({});
}

TEST_F(Assemble, KeepsFloatColour) {
  write_picture();
  render_parts({"--float"});
  expect_whole({"--float"});
}

TEST_F(Assemble, MakesHalfOfFloatAsTheWholeImageWouldHaveIt) {
  write_picture();
  render_parts({"--float"});
  expect_whole({}, {"--half"});
}

TEST_F(Assemble, KeepsFloatWhereOneValueIsBeyondHalf) {
  write_picture("", "1e6");
  render_parts({"--float"});
  expect_whole({}, {"--half"});
}

TEST_F(Assemble, RefusesColourThatIsRoundedInSomeParts) {
  write_picture("", "1e6");
  render_parts();
  const Outcome outcome = assemble({"a.exr", "b.exr", "c.exr", "d.exr", "-o", "out.exr"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.err.find("has 32-bit colour and"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("Render all parts with --float"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("out.exr"));
}

TEST_F(Assemble, TakesPartsThatOverlapWithTheSameBits) {
  write_picture();
  render("left.exr", {"--crop", "0,0,50,53"});
  render("right.exr", {"--crop", "20,0,75,53"});
  render("whole.exr", {});
  EXPECT_EQ(assemble({"left.exr", "right.exr", "left.exr", "-o", "out.exr"}).code, 0);
  EXPECT_TRUE(read("whole.exr") == read("out.exr"));
}

TEST_F(Assemble, TellsWhatIsMissing) {
  write_picture();
  render_parts();
  expect_misfit({"a.exr", "d.exr", "-o", "out.exr"},
                "parts are missing; render them with\n  --crop 31,0,75,29\n  --crop 0,29,75,30");
}

TEST_F(Assemble, TellsPartsOfAnotherImage) {
  write_picture();
  render_parts();
  render("other.exr", {"--crop", "0,30,75,53", "-s", "3"});
  expect_misfit({"a.exr", "b.exr", "c.exr", "other.exr", "-o", "out.exr"},
                "other.exr is a part of another image: backlight/samples is 3, and 2 in a.exr");
  render("other.exr", {"--crop", "0,30,75,53", "-r", "80x53"});
  expect_misfit(
      {"a.exr", "b.exr", "c.exr", "other.exr", "-o", "out.exr"},
      "other.exr is a part of another image: the size of the whole image is 80x53, and 75x53 in a.exr");
  render("other.exr", {"--crop", "0,30,75,53", "--aov", "none"});
  expect_misfit(
      {"a.exr", "b.exr", "c.exr", "other.exr", "-o", "out.exr"},
      "other.exr is a part of another image: the list of channels is A B G R, and A B G N.X N.Y N.Z P.X "
      "P.Y P.Z R Z doppler.D objectId.V in a.exr");
}

TEST_F(Assemble, FailsOnADamagedPart) {
  write_picture();
  render_parts();
  const std::string whole = read("c.exr");
  write("c.exr", whole.substr(0, whole.size() - 20));
  const Outcome outcome = assemble({"a.exr", "b.exr", "c.exr", "d.exr", "-o", "out.exr"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("cannot read c.exr"), std::string::npos) << outcome.err;
  EXPECT_FALSE(exists("out.exr"));
}

TEST_F(Assemble, NeedsPartsAndAName) {
  EXPECT_EQ(assemble({"-o", "out.exr"}).code, 2);
  EXPECT_EQ(assemble({"a.exr"}).code, 2);
  EXPECT_EQ(assemble({"a.exr", "-o", "out.png"}).code, 2);
  EXPECT_EQ(assemble({"a.exr", "-o", "out.exr"}).code, 4);
}

}  // namespace
}  // namespace backlight::test
