// The five ways of writing a velocity, and the frames that come of them (docs/physics.md section 1).
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "backlight/scene/compile.h"
#include "compiled.h"

namespace backlight {
namespace {

using testing_scenes::camera;
using testing_scenes::compiled;
using testing_scenes::mistakes;

// The celerity of a sphere with these keys.
ExtendedVec3 celerity_of(const std::string& keys, const std::string& top = "") {
  const Scene scene = compiled(top + camera + "[[object]]\nshape = \"sphere\"\nradius = 1\n" + keys);
  if (scene.frames.size() != 2) return {};
  return scene.frames[1].motion.celerity;
}

// Relative to a value known to 32 digits as hi + lo.
void expect_extended(Extended value, double hi, double lo) {
  const Extended difference = value - Extended(hi, lo);
  EXPECT_LE(std::abs(double(difference)), 1e-30 * std::abs(hi)) << value.hi << " + " << value.lo;
}

// Expected values by mpmath with 40 digits, from the doubles that are written.
TEST(Motion, VelocityIsDividedByC) {  // b/√(1-b²), b = 4.5/5
  const ExtendedVec3 u = celerity_of("velocity = [4.5, 0, 0]\n", "c = 5\n");
  expect_extended(u[0], 2.064741604835056, -8.37981901156169e-17);
  EXPECT_EQ(u[1], Extended(0.0));
}

TEST(Motion, BetaIsInUnitsOfC) {
  const ExtendedVec3 u = celerity_of("beta = [0, 0.8660254037844386, 0]\n", "c = 5\n");
  expect_extended(u[1], 1.732050807568877, -7.900792172917567e-17);
}

TEST(Motion, BetaOfTheLastDoubleBelowOneKeepsItsDigits) {
  const ExtendedVec3 u = celerity_of("beta = [0.99999999999999988897769753748, 0, 0]\n");
  expect_extended(u[0], 67108863.99999999, 1.8626451492309568e-09);
}

TEST(Motion, GammaBeyondWhatABetaCanSay) {  // √(γ²-1)
  expect_extended(celerity_of("gamma = 1e8\nalong = [0, 0, -7]\n")[2], -100000000.0, 5e-09);
}

TEST(Motion, GammaAlongAnyDirection) {  // √8 (1,2,2)/3
  const ExtendedVec3 u = celerity_of("gamma = 3\nalong = [1, 2, 2]\n");
  expect_extended(u[0], 0.9428090415820634, 9.566246218657683e-18);
  expect_extended(u[1], 1.8856180831641267, 1.9132492437315366e-17);
  EXPECT_EQ(u[1], u[2]);
}

TEST(Motion, TheLengthOfAlongDoesNotMatter) {
  for (const char* along : {"[1e-300, 0, 0]", "[3e300, 0, 0]", "[5e-324, 0, 0]"}) {
    EXPECT_EQ(double(celerity_of("celerity = 0.25\nalong = " + std::string(along) + "\n")[0]), 0.25) << along;
  }
}

TEST(Motion, RapidityIsExactAndMayBeNegative) {  // sinh
  expect_extended(celerity_of("rapidity = 5\nalong = [1, 0, 0]\n")[0], 74.20321057778875,
                  6.687957117824193e-15);
  expect_extended(celerity_of("rapidity = -0.3\nalong = [1, 0, 0]\n")[0], -0.3045202934471426,
                  -9.177343117072388e-18);
}

TEST(Motion, AllFormsOfOneVelocityMakeOneFrame) {
  // 3-4-5: β = 0.8, γ = 5/3, u = 4/3. γ and u are given as the doubles nearest to them, so that the frames
  // are within rounding of each other.
  const double celerity = double(celerity_of("velocity = [1.6, 0, 0]\n", "c = 2\n")[0]);
  EXPECT_NEAR(celerity, 4.0 / 3.0, 3e-16);
  EXPECT_NEAR(double(celerity_of("beta = [0.8, 0, 0]\n")[0]), 4.0 / 3.0, 1e-15);
  EXPECT_NEAR(double(celerity_of("gamma = \"5/3\"\nalong = [1, 0, 0]\n")[0]), 4.0 / 3.0, 1e-15);
  EXPECT_EQ(double(celerity_of("celerity = \"4/3\"\nalong = [2, 0, 0]\n")[0]), 4.0 / 3.0);
  EXPECT_NEAR(double(celerity_of("rapidity = \"log(3)\"\nalong = [1, 0, 0]\n")[0]), 4.0 / 3.0, 1e-15);
}

TEST(Motion, AtRestIsTheWorldBitForBit) {
  for (const char* keys :
       {"", "velocity = [0, 0, 0]\n", "velocity = [-0.0, 0, 0]\n", "gamma = 1\nalong = [1, 2, 3]\n",
        "rapidity = 0\nalong = [1, 0, 0]\n", "frame = \"world\"\n"}) {
    const Scene scene =
        compiled(camera + "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [0.1, 2, 3]\n" + keys);
    ASSERT_EQ(scene.frames.size(), 1U) << keys;
    EXPECT_EQ(scene.frames[0].motion, InertialFrame{});
    const BoundingSphere sphere = scene.frames[0].surfaces->bounds(0);
    EXPECT_EQ(sphere.centre, (Vec3{0.1, 2, 3})) << keys;
  }
}

TEST(Motion, AnOwnVelocityMakesAFrameAboutTheThing) {
  const Scene scene =
      compiled("c = 2\n" + camera +
               "[[object]]\nshape = \"sphere\"\nradius = 1\nposition = [1, 2, 3]\nvelocity = [1, 0, 0]\n");
  ASSERT_EQ(scene.frames.size(), 2U);
  const SceneFrame& frame = scene.frames[1];
  EXPECT_EQ(frame.motion.origin.t, Extended(0.0));
  EXPECT_EQ(frame.motion.origin.x.rounded(), (Vec3{1, 2, 3}));
  EXPECT_EQ(frame.surfaces->bounds(0).centre, Vec3{0.0});
  EXPECT_TRUE(frame.name.empty());
}

TEST(Motion, ThingsOfOneVelocityAndOriginShareAFrame) {
  const std::string sphere = "[[object]]\nshape = \"sphere\"\nradius = 1\n";
  const Scene scene =
      compiled("c = 2\n" + camera + "[frame.a]\nvelocity = [1, 0, 0]\n[frame.b]\nbeta = [0.5, 0, 0]\n" +
               sphere + "frame = \"a\"\n" + sphere + "frame = \"b\"\nposition = [0, 5, 0]\n" + sphere +
               "velocity = [1, 0, 0]\n" + sphere + "velocity = [1, 0, 0]\nposition = [0, 1, 0]\n" +
               "[[light]]\nvelocity = [1, 0, 0]\n");
  ASSERT_EQ(scene.frames.size(),
            3U);  // the world, that of three spheres and the light, and the last sphere's
  EXPECT_EQ(scene.frames[1].surfaces->size(), 3U);
  EXPECT_EQ(scene.frames[2].surfaces->size(), 1U);
  EXPECT_EQ(scene.lights[0].frame, 1);
  EXPECT_EQ(scene.frames[1].name, "a");
}

TEST(Motion, UnusedFramesCostNothing) {
  EXPECT_EQ(compiled(camera + "[frame.a]\nvelocity = [0.5, 0, 0]\n").frames.size(), 1U);
}

TEST(Motion, OriginTimeIsMultipliedByC) {
  const Scene scene = compiled("c = 5\n" + camera +
                               "[frame.a]\norigin = [1, 2, 3]\norigin_time = 0.1\n"
                               "[[object]]\nshape = \"plane\"\nframe = \"a\"\n");
  ASSERT_EQ(scene.frames.size(), 2U);
  EXPECT_EQ(scene.frames[1].motion.origin.t, Extended(5.0) * Extended(0.1));
  EXPECT_EQ(scene.frames[1].motion.origin.x.rounded(), (Vec3{1, 2, 3}));
}

TEST(Motion, FramesWithinFramesAddTheirRapidities) {
  const Scene scene =
      compiled(camera +
               "[frame.c]\nwithin = \"b\"\nrapidity = 0.5\nalong = [1, 0, 0]\norigin = [1, 0, 0]\n"
               "[frame.b]\nwithin = \"a\"\nrapidity = 0.25\nalong = [1, 0, 0]\n"
               "[frame.a]\nrapidity = -0.125\nalong = [1, 0, 0]\n"
               "[[object]]\nshape = \"plane\"\nframe = \"c\"\n");
  ASSERT_EQ(scene.frames.size(), 2U);
  const InertialFrame& frame = scene.frames[1].motion;
  EXPECT_NEAR(double(frame.celerity[0]), std::sinh(0.625), 1e-15);
  // (0; 1) of b, whose rapidity in the world is 0.125: t = sinh, x = cosh.
  EXPECT_NEAR(double(frame.origin.t), std::sinh(0.125), 1e-16);
  EXPECT_NEAR(double(frame.origin.x[0]), std::cosh(0.125), 1e-15);
}

TEST(Motion, MayDependOnTime) {
  const std::string text = "[animation]\nfps = 10\nframes = [1, 11]\n" + camera +
                           "[[object]]\nshape = \"plane\"\nbeta = [\"0.5*image_time\", 0, 0]\n";
  ImageRequest last;
  last.frame = 11;
  EXPECT_EQ(compiled(text).frames.size(), 1U);
  const Scene scene = compiled(text, last);
  ASSERT_EQ(scene.frames.size(), 2U);
  EXPECT_NEAR(double(scene.frames[1].motion.celerity[0]), 0.5 / std::sqrt(0.75), 2e-16);
}

TEST(Motion, SaysByHowMuchASpeedIsTooLarge) {
  const std::string text = mistakes("c = 5\n" + camera + "velocity = [0, 5.2, 0]\n");
  EXPECT_NE(text.find("|velocity| = 5.2 exceeds the speed of light, c = 5"), std::string::npos) << text;
}

}  // namespace
}  // namespace backlight
