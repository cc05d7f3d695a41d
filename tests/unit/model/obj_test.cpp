// Wavefront OBJ as it is found.
#include "files.h"

namespace backlight::test {
namespace {

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::vector<double> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

TEST(Obj, ReadsLinesInEveryDress) {
  EXPECT_EQ(corners_of(good("a.obj", three + "f 1 2 3\n")), triangle);
  EXPECT_EQ(corners_of(good("end.obj", three + "f 1 2 3")), triangle);
  EXPECT_EQ(corners_of(good("crlf.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n")), triangle);
  EXPECT_EQ(corners_of(good("cr.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r")), triangle);
  EXPECT_EQ(corners_of(good("mark.obj", "\xef\xbb\xbf" + three + "f 1 2 3\n")), triangle);
  EXPECT_EQ(corners_of(good("tabs.obj", "v\t0\t0 0  \n  v 1 0 0\nv 0 +1.0e0 0\nf\t1  2\t3 \n")), triangle);
  EXPECT_EQ(corners_of(good("comments.obj", "# v\n" + three + "f 1 2 3 # of a face\n")), triangle);
  EXPECT_EQ(corners_of(good("long.obj", "v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 \\\r\n 2\\\n 3\n")), triangle);
  EXPECT_EQ(corners_of(good("forwards.obj", "f 1 2 3\n" + three)), triangle);
  EXPECT_EQ(corners_of(good("backwards.obj", "v 9 9 9\n" + three + "f -3 -2 -1\n")), triangle);
  EXPECT_EQ(
      corners_of(good("more.obj", "v 0 0 0 1 0.5 0.2\nv 1 0 0 1\nv 0 1 0\ng a b\no c\ns off\nf 1// 2/ 3\n")),
      triangle);
}

TEST(Obj, KeepsEveryDigit) {
  const Model model =
      good("digits.obj", "v 0.1 1e-320 1e-999\nv 3.141592653589793238 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(corners_of(model), (std::vector<double>{0.1, 1e-320, 0, 3.141592653589793, 0, 0, 0, 1, 0}));
}

TEST(Obj, CutsPolygons) {
  const Model arrow = good("arrow.obj", "v 0 0 0\nv 1 3 0\nv 0 1 0\nv -1 3 0\nf 1 2 3 4\n");
  EXPECT_EQ(arrow.mesh.triangles.size(), 2U);
  EXPECT_NEAR(area_of(arrow).z, 4.0 - 2.0, 1e-14);  // twice (3 - 2)
  EXPECT_NEAR(size_of(arrow), area_of(arrow).z, 1e-14);
  // A comb, whose corners are seen from few places, along each axis and both ways round.
  const std::vector<std::array<double, 2>> comb{{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1},
                                                {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool turned : {false, true}) {
      std::string text, face = "f";
      for (std::size_t i = 0; i < comb.size(); ++i) {
        const auto& at = comb[turned ? comb.size() - 1 - i : i];
        double place[3]{};
        place[(axis + 1) % 3] = at[0];
        place[(axis + 2) % 3] = at[1];
        text += "v " + std::to_string(place[0]) + " " + std::to_string(place[1]) + " " +
                std::to_string(place[2]) + "\n";
        face += " " + std::to_string(i + 1);
      }
      const Model model = good("comb.obj", text + face + "\n");
      EXPECT_EQ(model.mesh.triangles.size(), comb.size() - 2);
      EXPECT_NEAR(area_of(model)[axis], turned ? -22.0 : 22.0, 1e-12);
      EXPECT_NEAR(size_of(model), 22.0, 1e-12);
    }
  }
  EXPECT_EQ(good("hexagon.obj", "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 2 2 0\nv 0 2 0\nv -1 1 0\nf 1 2 3 4 5 6\n")
                .mesh.triangles.size(),
            4U);
  // One that crosses itself, and one all of whose corners are on a line.
  EXPECT_EQ(good("bow.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n").mesh.triangles.size(), 2U);
  EXPECT_EQ(good("line.obj", three + "v 2 0 0\nv 3 0 0\nf 1 2 4 5\nf 1 2 3\n").mesh.triangles.size(), 3U);
}

TEST(Obj, KeepsNormalsWhereEveryCornerHasOne) {
  const std::string text = three + "vn 0 0 1\nvt 0.25 0.75\nvt 1\n";
  const Model model = good("normals.obj", text + "f 1/1/1 2/2/1 3//1\n");
  ASSERT_EQ(model.mesh.normals.size(), 3U);
  EXPECT_EQ(model.mesh.normals[0], (Vec3{0, 0, 1}));
  EXPECT_EQ(model.mesh.texture[0], (std::array{0.25, 0.25}));
  EXPECT_EQ(model.mesh.texture[1], (std::array{1.0, 1.0}));
  EXPECT_TRUE(good("some.obj", text + "f 1/1/1 2/2/1 3\n").mesh.normals.empty());
}

TEST(Obj, TakesMaterialsOfAllItsFiles) {
  write_model("one.mtl", "newmtl red\nKd 1 0 0\n");
  write_model("other one.mtl", "newmtl my blue\nKd 0 0 1\nKe 3 2 1\n");
  const std::string faces = "usemtl red\nf 1 2 3\nusemtl my blue\nf 2 3 1\nf 3 1 2\nusemtl gone\nf 1 2 3\n";
  const Model model =
      good("materials.obj", "mtllib model_one.mtl\nmtllib model_other one.mtl\n" + three + faces);
  EXPECT_EQ(model.mesh.members, (std::vector<std::uint32_t>{0, 1, 1, 2}));
  ASSERT_EQ(model.materials.size(), 3U);
  EXPECT_EQ(model.materials[1].name, "my blue");
  EXPECT_EQ(model.materials[1].emission, (std::array{3.0, 2.0, 1.0}));
  EXPECT_EQ(model.files.size(), 2U);
  EXPECT_EQ(good("two.obj", "mtllib model_one.mtl model_gone.mtl\n" + three + "f 1 2 3\n").missing.filename(),
            "model_gone.mtl");
}

TEST(Obj, RefusesWhatIsWrong) {
  EXPECT_EQ(refusal("nan.obj", "v 0 nan 0\n"), "line 1: expected finite numbers");
  EXPECT_EQ(refusal("large.obj", "\nv 0 1e999 0\n"), "line 2: expected finite numbers");
  EXPECT_EQ(refusal("few.obj", "v 0 0\n"), "line 1: expected more numbers");
  EXPECT_EQ(refusal("zero.obj", three + "f 0 1 2\n"),
            "line 4: a face names the vertex 0; they are counted from 1");
  EXPECT_EQ(refusal("far.obj", three + "f 1 2 4\n"), "a face names the vertex 4, and there are 3");
  EXPECT_EQ(refusal("before.obj", three + "f -4 -1 -2\n"), "a face names the vertex -4, and there are 3");
  EXPECT_EQ(refusal("huge.obj", three + "f 1 2 99999999999999999999\n"),
            "line 4: expected a number of vertex");
  EXPECT_EQ(refusal("texture.obj", three + "f 1/1 2/1 3/1\n"),
            "a face names the texture vertex 1, and there are 0");
  EXPECT_EQ(refusal("normal.obj", three + "f 1//1 2//1 3//1\n"),
            "a face names the normal 1, and there are 0");
  EXPECT_EQ(refusal("words.obj", three + "f a b c\n"), "line 4: expected a number of vertex");
  EXPECT_EQ(refusal("stars.obj", three + "f 1*2 2 3\n"), "line 4: expected numbers of vertices, as in 1/2/3");
  EXPECT_EQ(refusal("curve.obj", three + "surf 0 1 0 1 1 2 3\n"),
            "line 4: free-form curves and surfaces are not supported: save it as polygons");
  EXPECT_EQ(refusal("bytes.obj", three + std::string(1, '\0') + "\n"), "line 4 is no text");
}

}  // namespace
}  // namespace backlight::test
