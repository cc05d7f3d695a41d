// Objects, materials, lights, sky, effects, film and time of a compiled scene.
#include "backlight/scene/compile.h"

#include <gtest/gtest.h>

#include <cmath>

#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;
using testing_scenes::mistakes;

constexpr double tight = 1e-14;

// Where a ray along +z from far away first meets what is in the world.
double first_z(const Scene& scene, double x, double y) {
  return scene.frames[0].surfaces->nearest({x, y, -100}, {0, 0, 1}).lambda - 100;
}

TEST(CompileTime, IsThatOfTheAnimationsFrame) {
  const std::string text = "[animation]\nfps = 25\nframes = [11, 13]\n" + camera;
  EXPECT_EQ(compiled(text).time, 0.4);
  EXPECT_EQ(compiled(text).frame, 11.0);
  ImageRequest request;
  request.frame = 26;
  EXPECT_EQ(compiled(text, request).time, 1.0);
  request.frame.reset();
  request.time = 0.5;
  EXPECT_EQ(compiled(text, request).frame, 13.5);
  EXPECT_EQ(animation_frames(*read_scene_text(text).description), (std::vector<int>{11, 12, 13}));
}

TEST(CompileTime, IsZeroWithoutAnAnimation) {
  EXPECT_EQ(compiled(camera).time, 0.0);
  EXPECT_EQ(compiled(camera).frame, 1.0);
  ImageRequest request;
  request.frame = 7;
  EXPECT_EQ(compiled(camera, request).time, 0.0);
  EXPECT_EQ(compiled(camera, request).frame, 7.0);
  EXPECT_EQ(animation_frames(*read_scene_text(camera).description), std::vector<int>{1});
}

TEST(CompileParameters, UseEachOtherInAnyOrder) {
  const Scene scene =
      compiled("c = \"b\"\n[params]\na = \"b + 1\"\nb = \"2*d\"\nd = 1.5\n" + camera + "fov = \"a * 10\"\n");
  EXPECT_EQ(scene.c, 3.0);
  EXPECT_NEAR(scene.camera.lens.fov, 40.0 * std::acos(-1.0) / 180.0, tight);
}

TEST(CompileParameters, MayUseTimeAndFrame) {
  const std::string text =
      "[params]\na = \"t + 100*frame\"\n[animation]\nfps = 1\nframes = [3, 3]\n[film]\nsamples = \"a\"\n";
  EXPECT_EQ(compiled(text + camera).film.samples, 302);
}

TEST(CompileFilm, DefaultsAndRequests) {
  const Scene plain = compiled(camera);
  EXPECT_EQ(plain.film.width, 720);
  EXPECT_EQ(plain.film.height, 526);
  EXPECT_EQ(plain.film.samples, 1);
  EXPECT_EQ(plain.film.seed, 0U);
  EXPECT_TRUE(plain.film.aovs.empty());
  ImageRequest request;
  request.resolution = {{64, 48}};
  request.samples = 4;
  request.seed = 9;
  request.aovs = std::vector<std::string>{"P", "Z", "P"};
  const Scene scene =
      compiled("[film]\nresolution = [1, 2]\nsamples = 3\naovs = [\"N\"]\n" + camera, request);
  EXPECT_EQ(scene.film.width, 64);
  EXPECT_EQ(scene.camera.lens.height, 48);
  EXPECT_EQ(scene.film.samples, 4);
  EXPECT_EQ(scene.film.seed, 9U);
  EXPECT_EQ(scene.film.aovs, (std::vector<std::string>{"P", "Z"}));
}

TEST(CompileFilm, RequestsAreCheckedLikeTheFile) {
  ImageRequest request;
  request.resolution = {{0, 48}};
  request.aovs = std::vector<std::string>{"dopler"};
  EXPECT_EQ(mistakes(camera, request),
            "error: 'resolution' is 0 on the command line, but must be a whole number, at least 1 and at "
            "most 65536\n"
            "error: there is no AOV 'dopler'\n  did you mean 'doppler'?\n");
}

TEST(CompileObjects, EachShapeIsWhereAndAsLargeAsWritten) {
  const auto at = [](const std::string& keys) {
    return first_z(compiled(camera + "[[object]]\nposition = [10, 0, 0]\n" + keys), 10, 0.01);
  };
  EXPECT_NEAR(at("shape = \"sphere\"\nradius = 2\n"), -std::sqrt(4 - 1e-4), tight);
  EXPECT_NEAR(at("shape = \"box\"\nsize = [1, 2, 3]\n"), -1.5, tight);
  EXPECT_NEAR(at("shape = \"cylinder\"\nradius = 2\nheight = 1\n"), -2.0, tight);
  EXPECT_NEAR(at("shape = \"cone\"\nradius = 2\nheight = 2\n"), -(1 - 0.01), tight);
  EXPECT_NEAR(at("shape = \"cone\"\nradius = 2\ntop_radius = 2\nheight = 2\n"), -2.0, tight);
  EXPECT_NEAR(at("shape = \"torus\"\nmajor = 2\nminor = 0.5\n"), -(2 + std::sqrt(0.25 - 1e-4)), 1e-13);
  EXPECT_NEAR(at("shape = \"disk\"\nradius = 2\nrotate = [-90, 0, 0]\n"), 0.0, tight);
  EXPECT_NEAR(at("shape = \"plane\"\nrotate = [90, 0, 0]\n"), 0.0, tight);
  EXPECT_NEAR(at("shape = \"quadric\"\ncoefficients = [0, 0, 1, 0, 0, 0, 0, 0, 0, -9]\n"), -3.0, tight);
}

TEST(CompileObjects, AreTurnedAboutXThenYThenZ) {
  // The box's long side goes from x by the turn about y to -z, and the turn about z leaves it there.
  const Scene scene =
      compiled(camera + "[[object]]\nshape = \"box\"\nsize = [8, 1, 1]\nrotate = [90, 90, 45]\n");
  EXPECT_NEAR(first_z(scene, 0, 0), -4.0, tight);
}

TEST(CompileObjects, ScaleIsANumberOrThree) {
  const std::string sphere = camera + "[[object]]\nshape = \"sphere\"\nradius = 1\n";
  EXPECT_NEAR(first_z(compiled(sphere + "scale = 2\n"), 0, 0), -2.0, tight);
  EXPECT_NEAR(first_z(compiled(sphere + "scale = [1, 1, 3]\n"), 0, 0), -3.0, tight);
}

TEST(CompileObjects, CopiesShareNumberAndMaterial) {
  const Scene scene = compiled(camera +
                               "[[object]]\nshape = \"plane\"\nposition = [0, -9, 0]\n"
                               "[[object]]\nshape = \"sphere\"\nradius = 0.5\nposition = [1, 0, 0]\n"
                               "repeat = { count = [3, 2, 1], step = [2, 4, 9] }\n");
  ASSERT_EQ(scene.frames[0].surfaces->size(), 7U);
  EXPECT_EQ(scene.objects.size(), 2U);
  EXPECT_EQ(scene.objects[1].id, 2);
  EXPECT_EQ(scene.frames[0].object_of_surface, (std::vector<int>{0, 1, 1, 1, 1, 1, 1}));
  EXPECT_EQ(scene.frames[0].surfaces->bounds(2).centre, (Vec3{3, 0, 0}));
  EXPECT_EQ(scene.frames[0].surfaces->bounds(6).centre, (Vec3{5, 4, 0}));
}

TEST(CompileObjects, AreNumberedInFileOrderWhateverTheirFrame) {
  const Scene scene = compiled(camera +
                               "[[object]]\nshape = \"plane\"\nvelocity = [0, 0, 0.5]\nname = \"a\"\n"
                               "[[object]]\nshape = \"plane\"\nname = \"b\"\n");
  EXPECT_EQ(scene.objects[0].name, "a");
  EXPECT_EQ(scene.objects[0].id, 1);
  EXPECT_EQ(scene.frames[0].object_of_surface, std::vector<int>{1});
  EXPECT_EQ(scene.frames[1].object_of_surface, std::vector<int>{0});
}

TEST(CompileEffects, AreNaturesByDefault) {
  EXPECT_EQ(compiled(camera).effects, Effects{});
  EXPECT_EQ(compiled(camera + "[effects]\nlight_delay = true\nsearchlight = \"exact\"\n").effects, Effects{});
}

TEST(CompileEffects, SearchlightSetsThreeSwitches) {
  const auto switches = [](const std::string& keys) {
    return compiled(camera + "[effects]\n" + keys).effects.brightness;
  };
  EXPECT_EQ(switches("searchlight = \"off\"\n"), (BrightnessSwitches{false, ArrivalRate::off, false}));
  EXPECT_EQ(switches("searchlight = \"paper\"\n"), (BrightnessSwitches{true, ArrivalRate::dilation, true}));
  EXPECT_EQ(switches("searchlight = \"off\"\nenergy = true\n"),
            (BrightnessSwitches{true, ArrivalRate::off, false}));
  EXPECT_EQ(switches("rate = \"dilation\"\nsolid_angle = false\n"),
            (BrightnessSwitches{true, ArrivalRate::dilation, false}));
}

TEST(CompileEffects, RegionsInheritWhatTheyDoNotSay) {
  const Scene scene =
      compiled(camera +
               "[effects]\ndoppler = false\nrate = \"dilation\"\n"
               "[[effects.region]]\nrect = [0, 0.25, 0.5, 1]\nlight_delay = false\n"
               "[[effects.region]]\nrect = [0, 0, 1, 1]\nsearchlight = \"exact\"\ndoppler = true\n");
  ASSERT_EQ(scene.regions.size(), 2U);
  EXPECT_EQ(scene.regions[0].y0, 0.25);
  EXPECT_EQ(scene.regions[0].effects,
            (Effects{false, false, BrightnessSwitches{true, ArrivalRate::dilation, true}}));
  EXPECT_EQ(scene.regions[1].effects, Effects{});
}

TEST(CompileErrors, AScenesReadingErrorsForbidIt) {
  ReadResult read = read_scene_text(camera + "fovv = 3\n");
  ASSERT_TRUE(read.description.has_value());
  ResourceCache cache;
  EXPECT_FALSE(compile(*read.description, {}, cache, read.diagnostics).has_value());
  EXPECT_EQ(read.diagnostics.error_count(), 1U);
}

// What identifies an image can still be said when what is in it has been forgotten.
TEST(SceneDescription, WithoutItsContentsTellsTheSameFactsOfAnImage) {
  const std::string text =
      "[params]\nn = 3\n[film]\nresolution = [40, 30]\nsamples = \"n + 8 - frame\"\n[animation]\nfps = "
      "10\nframes = "
      "[1, 20]\n[[camera]]\nname = \"first\"\nposition = [\"t\", 0, -5]\n[[camera]]\nname = \"second\"\n"
      "[material.red]\ncolor = [1, 0, 0]\n[[light]]\nposition = [0, 5, 0]\n[[object]]\nshape = \"sphere\"\n"
      "radius = 1\nmaterial = \"red\"\n";
  ReadResult read = read_scene_text(text, "scene.toml");
  ASSERT_TRUE(read.description.has_value());
  Description& description = *read.description;
  ImageRequest request;
  request.frame = 7;
  request.camera = "second";
  const auto before = image_facts(description, request);
  ASSERT_TRUE(before.has_value());

  description.forget_contents();
  EXPECT_EQ(find(description.root, "object"), nullptr);
  EXPECT_EQ(find(description.root, "material"), nullptr);
  const auto after = image_facts(description, request);
  ASSERT_TRUE(after.has_value());
  EXPECT_EQ(after->time, before->time);
  EXPECT_EQ(after->time, 0.6);
  EXPECT_EQ(after->frame, before->frame);
  EXPECT_EQ(after->camera, "second");
  EXPECT_EQ(after->film.width, 40);
  EXPECT_EQ(after->film.samples, 4);
  request.frame = 12;  // minus one sample: wrong, with no text to show
  EXPECT_FALSE(image_facts(description, request).has_value());
}

}  // namespace
}  // namespace backlight
