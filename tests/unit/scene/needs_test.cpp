// The least model that a scene needs, and how it is explained.
#include "backlight/scene/needs.h"

#include <gtest/gtest.h>

#include "backlight/scene/explain.h"
#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;

const std::string sphere = "[[object]]\nshape = \"sphere\"\nradius = 1\n";
const std::string moving = sphere + "name = \"tram\"\nbeta = [0.5, 0, 0]\n";
const std::string lamp = "[[light]]\n";

Needs needs(const std::string& text) {
  return needs_of(compiled(text));
}

TEST(SceneNeeds, AtRestRedGreenBlueIsEnough) {
  const Needs n = needs(camera + sphere + lamp + "[background]\ncolor = [1, 1, 1]\n");
  EXPECT_FALSE(n.spectral);
  EXPECT_EQ(n.wavelengths, 0);
  EXPECT_EQ(n.why, "nothing moves relative to anything else");
  EXPECT_TRUE(n.shadow_rays);
  EXPECT_EQ(n.frames, 1U);
  EXPECT_EQ(n.moving_frames, 0U);
}

TEST(SceneNeeds, TheSameSpeedWrittenInTwoWaysIsTheSameSpeed) {
  const Needs n = needs("c = 5\n[camera]\nvelocity = [0, 0, 4.5]\n" + sphere + "beta = [0, 0, 0.9]\n" + lamp +
                        "beta = [0, 0, 0.9]\n");
  EXPECT_FALSE(n.spectral);
  EXPECT_EQ(n.moving_frames, 0U);
}

TEST(SceneNeeds, WhatMovesAgainstTheCameraNeedsSpectra) {
  const Needs n = needs(camera + moving + sphere);
  EXPECT_TRUE(n.spectral);
  EXPECT_GT(n.wavelengths, 3);
  EXPECT_EQ(n.why, "object 'tram' moves relative to the camera");
  EXPECT_FALSE(n.shadow_rays);
  EXPECT_EQ(n.frames, 2U);
  EXPECT_EQ(n.moving_frames, 1U);
}

TEST(SceneNeeds, AllMovingTogetherIsRest) {
  EXPECT_FALSE(needs("[camera]\nbeta = [0.5, 0, 0]\n" + moving + "[[light]]\nbeta = [0.5, 0, 0]\n").spectral);
}

TEST(SceneNeeds, ALampThatMovesNeedsSpectraOnlyWhereItShines) {
  const std::string moving_lamp = "[[light]]\nname = \"lamp\"\nbeta = [0.5, 0, 0]\n";
  EXPECT_EQ(needs(camera + sphere + moving_lamp).why,
            "light 'lamp' and frame 'world' move relative to each other");
  EXPECT_FALSE(needs(camera + moving_lamp).spectral);
  EXPECT_FALSE(needs(camera + sphere + "[[light]]\ntype = \"ambient\"\nbeta = [0.5, 0, 0]\n").spectral);
}

TEST(SceneNeeds, TheBackgroundOnlyIfItShines) {
  const std::string moving_camera = "[camera]\nbeta = [0.5, 0, 0]\n";
  EXPECT_TRUE(needs(moving_camera + "[background]\ncolor = [1, 1, 1]\n").spectral);
  EXPECT_FALSE(needs(moving_camera).spectral);
  const Needs stars = needs(moving_camera + "[background]\nstars = { count = 10 }\n");
  EXPECT_FALSE(stars.spectral);
  EXPECT_EQ(stars.stars, 10U);
  EXPECT_EQ(stars.why, "only stars shift, and their colours are found once an image");
}

TEST(SceneNeeds, EffectsDecideForEveryPartOfTheImage) {
  const std::string off = "[effects]\ndoppler = false\n";
  EXPECT_FALSE(needs(camera + moving + off).spectral);
  EXPECT_EQ(needs(camera + moving + off).why, "the effects show no shift of colours");
  EXPECT_TRUE(needs(camera + moving + off + "[[effects.region]]\nrect = [0, 0, 0.5, 0.5]\ndoppler = true\n")
                  .spectral);
  // Without light delay nothing shifts on the way to the camera, but it does on the way from a lamp.
  EXPECT_FALSE(needs(camera + moving + "[effects]\nlight_delay = false\n").spectral);
  EXPECT_TRUE(needs(camera + moving + lamp + "[effects]\nlight_delay = false\n").spectral);
}

TEST(SceneNeeds, CopiesAreSurfaces) {
  const Needs n = needs(camera + sphere + "repeat = { count = [3, 2, 1], step = [3, 3, 3] }\n");
  EXPECT_EQ(n.objects, 1U);
  EXPECT_EQ(n.surfaces, 6U);
}

TEST(SceneNeeds, NamesTheRootFinderOfEverySurface) {
  const std::string formula = "[[object]]\nshape = \"implicit\"\nbounds = [[-2, -2, -2], [2, 2, 2]]\nf = ";
  const std::string torus = "[[object]]\nshape = \"torus\"\nmajor = 2\nminor = 1\n";
  const std::string solid =
      "[[object]]\nshape = \"difference\"\n[[object.part]]\nshape = \"torus\"\nmajor = 2\nminor = 1\n"
      "[[object.part]]\nshape = \"box\"\nsize = [1, 1, 1]\n[[object.part]]\nshape = \"sphere\"\nradius = 1\n";
  const Needs n = needs(camera + sphere + "repeat = { count = [3, 2, 1], step = [3, 3, 3] }\n" + torus +
                        solid + formula + "\"x^4 + y^4 + z^4 - 1\"\n" + sphere);
  ASSERT_EQ(n.roots.size(), 4U);
  EXPECT_EQ(n.roots[0].surfaces, 7U);
  EXPECT_EQ(n.roots[3].shape, ShapeKind::implicit);
  EXPECT_EQ(in_words(n.roots),
            "7 spheres: closed form; 1 torus: quartic; 1 solid: CSG of quartic and closed form; "
            "1 implicit surface: " +
                n.roots[3].how);
  EXPECT_EQ(in_words({}), "none");
}

TEST(SceneNeeds, ExtendedPrecisionIsForFastFramesAlone) {
  const auto at_gamma = [](const std::string& gamma) {
    return needs(camera + sphere + "gamma = " + gamma + "\nalong = [0, 1, 0]\n").extended_frames;
  };
  EXPECT_EQ(at_gamma("29"), 0U);
  EXPECT_EQ(at_gamma("31"), 1U);
  // What counts is the motion against the camera.
  EXPECT_EQ(needs("[camera]\nbeta = [0, 0.9998, 0]\n" + sphere + "beta = [0, 0.9998, 0]\n").extended_frames,
            0U);
}

TEST(SceneExplain, SaysWhatThereIs) {
  const std::string text = "c = 2\n[film]\nresolution = [64, 48]\naovs = [\"Z\", \"P\"]\n" + camera + moving +
                           lamp + "[effects]\nrate = \"dilation\"\n";
  const ReadResult read = read_scene_text(text, "tram.toml");
  EXPECT_EQ(
      explain(*read.description, compiled(text), needs(text)),
      "tram.toml: at t = 0 s with c = 2\n"
      "  image      64 x 48 pixels, 1 sample each; AOVs Z and P\n"
      "  camera     perspective, 60 degrees wide; at rest\n"
      "             exposed at its own time 0 s, world time 0 s, at [0, 0, -5]\n"
      "  objects    1 object in 1 frame, 1 moving relative to the camera\n"
      "  frame of 'tram': 0.5 c (gamma = 1.1547) along [1, 0, 0]; 1 surface\n"
      "  roots      1 sphere: closed form\n"
      "  lights     1 light\n"
      "  background black\n"
      "  effects    light delay on, colour shift on, brightness D (energy) x gamma (rate) x D^2 (solid "
      "angle)\n"
      "  model      spectral: object 'tram' moves relative to the camera; " +
          std::to_string(needs(text).wavelengths) +
          " wavelengths for reflectances, the default; lights, tables and lines are summed whole; shadow "
          "rays; no textures, OpenImageIO is not loaded\n"
          "  arithmetic double precision; a ray is boosted into 1 frame\n");
}

TEST(SceneExplain, NearTheSpeedOfLightSaysWhatIsMissing) {
  const std::string text = camera + sphere + "gamma = 1e6\nalong = [0, 0, 1]\n";
  const ReadResult read = read_scene_text(text);
  const std::string said = explain(*read.description, compiled(text), needs(text));
  EXPECT_NE(said.find("c (1 - 5e-13) (gamma = 1e+06) along [0, 0, 1]"), std::string::npos) << said;
}

}  // namespace
}  // namespace backlight
