// What other programs hand in and read: a scene on standard input, JSON, JUnit, codes beside words.
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "program.h"

namespace backlight::test {
namespace {

using nlohmann::json;

class Pipeline : public ProgramTest {
 protected:
  // From now on the file is the standard input.
  void read_from(const std::string& name) {
    in_child = [path = (folder / "work" / name).string()] {
      dup2(open(path.c_str(), O_RDONLY), STDIN_FILENO);
    };
  }

  json statistics(const std::string& scene) {
    write("scene.toml", scene);
    const Outcome outcome = run({"scene.toml", "-q", "--stats", "-"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return json::parse(outcome.out);
  }
};

TEST_F(Pipeline, ASceneOnStandardInputIsTheSameScene) {
  write_scene();
  ASSERT_EQ(run({"scene.toml", "-q", "-o", "file.exr"}).code, 0);
  read_from("scene.toml");
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"-"}, {"render", "-q", "-"}, {"-q", "-", "-o", "stdin.exr"}}) {
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(run({"compare", "file.exr", "stdin.exr", "--fail", "0"}).code, 0);
    std::filesystem::remove(folder / "work" / "stdin.exr");
  }
}

TEST_F(Pipeline, AnImageFromStandardInputIsRecognised) {
  write_scene();
  ASSERT_EQ(run({"scene.toml", "-q", "-o", "a.exr"}).code, 0);
  read_from("scene.toml");
  EXPECT_NE(run({"-", "-o", "a.exr", "--skip-existing"}).err.find("is complete: skipped"), std::string::npos);
}

TEST_F(Pipeline, ErrorsOnStandardInputHaveLineAndColumn) {
  write("scene.toml", "[camera]\nfov = -3\n");
  read_from("scene.toml");
  for (const char* command : {"check", "render"}) {
    const Outcome outcome = run({command, "-"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(outcome.err.starts_with("<stdin>:2:7: error: ")) << outcome.err;
  }
  EXPECT_EQ(files(), std::vector<std::string>{"scene.toml"});
}

TEST_F(Pipeline, PathsInASceneOnStandardInputStartAtTheCurrentFolder) {
  write_scene("part.toml");
  write("scene.toml", "include = [\"part.toml\"]\n[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n");
  read_from("scene.toml");
  const Outcome outcome = run({"check", "-", "-q"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err.find("error"), std::string::npos);
}

TEST_F(Pipeline, StandardInputThatCannotBeReadIsFileTrouble) {
  in_child = [] { close(STDIN_FILENO); };
  const Outcome outcome = run({"-"});
  EXPECT_EQ(outcome.code, 4);
  EXPECT_NE(outcome.err.find("cannot read standard input: "), std::string::npos) << outcome.err;
}

TEST_F(Pipeline, ARenderThatWaitsForItsSceneCanBeStopped) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  in_child = [&] { dup2(ends[0], STDIN_FILENO); };
  const Outcome outcome = run_and({"-"}, [](int process) {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    kill(process, SIGTERM);
  });
  close(ends[0]);
  close(ends[1]);
  EXPECT_EQ(outcome.code, 128 + SIGTERM);
  EXPECT_NE(outcome.err.find("cannot read standard input: stopped by a signal"), std::string::npos)
      << outcome.err;
}

TEST_F(Pipeline, InfoAsJsonHasWhatTheRowsHave) {
  write_scene("scene.toml", "[params]\na = 1\n");
  ASSERT_EQ(
      run({"scene.toml", "-q", "-o", "a.exr", "--aov", "Z", "-D", "params.a=2", "--crop", "0,0,16,20"}).code,
      0);
  const Outcome outcome = run({"info", "--json", "a.exr", "a.exr"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const json info = json::parse(line);
    EXPECT_EQ(info["file"], "a.exr");
    EXPECT_EQ(info["part"], 1);
    EXPECT_EQ(info["parts"], 1);
    EXPECT_EQ(info["width"], 32);
    EXPECT_EQ(info["height"], 20);
    EXPECT_EQ(info["dataWindow"], json::array({0, 0, 16, 20}));
    EXPECT_EQ(info["channels"]["R"], "half");
    EXPECT_EQ(info["channels"]["Z"], "float");
    EXPECT_EQ(info["notRead"], nullptr);
    const json& attributes = info["attributes"];
    EXPECT_EQ(attributes["backlight/scene"], "scene.toml");
    EXPECT_EQ(attributes["backlight/overrides"], json::array({"params.a=2"}));
    EXPECT_EQ(attributes["backlight/cameraVelocity"], json::array({0, 0, 0}));
    EXPECT_EQ(attributes["backlight/complete"], 1);
    EXPECT_EQ(attributes["backlight/c"], 1);
    EXPECT_TRUE(attributes["Software"].get<std::string>().starts_with("Backlight "));
  }
  EXPECT_EQ(count, 2);
  EXPECT_EQ(run({"info", "--json", "none.exr"}).code, 4);
}

TEST_F(Pipeline, VerdictsAsJUnit) {
  for (const char* side : {"ref", "new"}) std::filesystem::create_directory(folder / "work" / side);
  write_scene();
  const auto render = [this](const std::string& file, const std::string& exposure) {
    ASSERT_EQ(run({"scene.toml", "-q", "-o", file, "-D", "film.exposure=" + exposure}).code, 0);
  };
  for (const char* file :
       {"ref/equal.exr", "new/equal.exr", "ref/differs.exr", "ref/missing.exr", "new/a&b<\".exr"}) {
    render(file, "1");
  }
  render("new/differs.exr", "2");
  write("ref/broken.exr", "no image");
  write("new/broken.exr", "no image");
  EXPECT_EQ(run({"compare", "ref", "new", "-q", "--junit", "out/report.xml"}).code, 2);
  const std::string report = read("out/report.xml");
  EXPECT_TRUE(report.starts_with(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<testsuites tests=\"5\" failures=\"3\" errors=\"1\">\n"
      "  <testsuite name=\"backlight compare\" tests=\"5\" failures=\"3\" errors=\"1\">\n"))
      << report;
  for (const char* part :
       {"<testcase classname=\"backlight.compare\" name=\"equal.exr\"/>\n",
        "name=\"a&amp;b&lt;&quot;.exr\">\n", "<failure type=\"extra\" message=\"",
        "<failure type=\"missing\" message=\"", "<error type=\"trouble\" message=\"",
        "<failure type=\"differs\" message=\"differs: ", "  </testsuite>\n</testsuites>\n"}) {
    EXPECT_NE(report.find(part), std::string::npos) << part << '\n' << report;
  }

  // What --update has put right is no failure any more.
  std::filesystem::remove(folder / "work/ref/broken.exr");
  std::filesystem::remove(folder / "work/new/broken.exr");
  std::filesystem::remove(folder / "work/ref/missing.exr");
  EXPECT_EQ(run({"compare", "ref", "new", "-q", "--update", "--junit", "out/report.xml"}).code, 0);
  EXPECT_NE(read("out/report.xml").find("tests=\"3\" failures=\"0\" errors=\"0\""), std::string::npos);
}

TEST_F(Pipeline, StatisticsHaveCodesBesideWords) {
  const std::string camera =
      "[film]\nresolution = [8, 5]\n[camera]\nposition = [0, 0, -5]\nlook_at = [0, 0, 0]\n";
  const std::string still = "[[object]]\nshape = \"sphere\"\nradius = 1\n";
  const std::string lamp = "[[light]]\ntype = \"point\"\nposition = [0, 3, 0]\nintensity = 9\n";
  const auto codes = [this](const std::string& scene) {
    const json line = statistics(scene);
    EXPECT_FALSE(line["modelWhy"].get<std::string>().empty());
    return line["modelCode"].get<std::string>() + " " + line["wavelengthsCode"].get<std::string>();
  };
  EXPECT_EQ(codes(camera + still), "nothing-moves none");
  EXPECT_EQ(codes(camera + still + "velocity = [0.5, 0, 0]\n"), "object-moves default");
  EXPECT_EQ(codes("film.wavelengths = 16\nfilm.resolution = [8, 5]\n" +
                  camera.substr(camera.find("[camera]")) + still + "velocity = [0.5, 0, 0]\n"),
            "object-moves given");
  EXPECT_EQ(codes("film.tolerance = 0.05\nfilm.resolution = [8, 5]\n" +
                  camera.substr(camera.find("[camera]")) + still + "velocity = [0.5, 0, 0]\n"),
            "object-moves tolerance");
  EXPECT_EQ(codes(camera + still + lamp + "velocity = [0.5, 0, 0]\n"), "light-moves default");
  EXPECT_EQ(codes(camera + still + "velocity = [0.5, 0, 0]\n[effects]\ndoppler = false\n"),
            "effects-off none");
  EXPECT_EQ(codes(camera + "velocity = [0.5, 0, 0]\n[background]\ncolor = [1, 1, 1]\n"),
            "background-moves default");

  const json line = statistics(camera + still + "[[object]]\nshape = \"torus\"\nmajor = 2\nminor = 0.5\n");
  EXPECT_EQ(line["rootSearches"], json::parse(R"([{"shape":"sphere","finder":"closed-form","surfaces":1},
                            {"shape":"torus","finder":"quartic","surfaces":1}])"));
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  EXPECT_EQ(line["host"], host.data());
}

TEST_F(Pipeline, PeakMemoryIsThatOfTheProcess) {
  write_scene();
  const auto peak = [this](const std::string& size) {
    const Outcome outcome = run({"scene.toml", "-q", "--stats", "-", "-s", "2", "-r", size});
    return json::parse(outcome.out)["peakMemory"].get<double>();
  };
  const double small = peak("32x20");
  EXPECT_GT(small, 1e6);
  EXPECT_GT(peak("2000x1000"), small + 2e6 * 16);  // four channels of four bytes
}

}  // namespace
}  // namespace backlight::test
