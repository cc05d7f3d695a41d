// PLY as it is found.
#include <limits>

#include "files.h"

namespace backlight::test {
namespace {

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment by hand\nobj_info none\n" + elements + "end_header\n";
}

std::string vertices(int count, const std::string& type) {
  return "element vertex " + std::to_string(count) + "\nproperty " + type + " x\nproperty " + type +
         " y\nproperty " + type + " z\n";
}

const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::vector<double> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

template <class Place, class Count, class Index>
void expect_square(const std::string& place, const std::string& count, const std::string& index) {
  for (const bool big : {false, true}) {
    const std::string head = header(
        big ? "binary_big_endian" : "binary_little_endian",
        vertices(4, place) + "element face 1\nproperty list " + count + " " + index + " vertex_index\n");
    const std::string body = bytes_of<Place>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, big) +
                             bytes_of<Count>({4}, big) + bytes_of<Index>({0, 1, 2, 3}, big);
    EXPECT_EQ(corners_of(good("binary.ply", head + body)), square) << head;
    EXPECT_EQ(refusal("cut.ply", head + body.substr(0, body.size() - 1)),
              "it is cut short: it ends within its 1 of 'face'");
  }
}

TEST(Ply, ReadsAllTypesEitherWayRound) {
  expect_square<float, std::uint8_t, std::int32_t>("float", "uchar", "int");
  expect_square<float, std::uint8_t, std::uint32_t>("float32", "uint8", "uint32");
  expect_square<double, std::int32_t, std::uint16_t>("double", "int", "ushort");
  expect_square<double, std::uint16_t, std::int16_t>("float64", "uint16", "short");
  expect_square<std::int16_t, std::int8_t, std::uint8_t>("short", "char", "uchar");
  expect_square<std::int32_t, std::uint32_t, std::int8_t>("int32", "uint", "int8");
}

TEST(Ply, ReadsText) {
  const std::string body = "0 0 0 1 0 0\n1 1 0\r\n0 1 0\n4 0 1 2 3\n";
  EXPECT_EQ(corners_of(good("text.ply", header("ascii", vertices(4, "float") + faces) + body)), square);
  std::string head = header("ascii", vertices(4, "double") + faces), ends;
  for (const char c : head) ends += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(corners_of(good("crlf.ply", ends + body)), square);
  // Every digit of numbers that say that they are doubles.
  const Model far = good("far.ply", header("ascii", vertices(3, "double") + faces) +
                                        "1000000.1 0 0\n1000001.1 0 0\n1000000.1 1 0\n3 0 1 2\n");
  EXPECT_EQ(far.mesh.places[0].x, 1000000.1);
}

TEST(Ply, FindsItsWayAmongOtherElementsAndLists) {
  const std::string elements =
      "element camera 1\nproperty float a\nproperty list uchar int b\n" + vertices(3, "float") +
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty list uchar int "
      "marks\n"
      "property float s\nproperty float t\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"
      "element face 1\nproperty uchar flags\nproperty list uchar int vertex_indices\nproperty float area\n";
  const std::string body =
      "3.5 2 7 8\n0 0 0 0 0 1 255 1 9 0 0\n1 0 0 0 0 1 255 0 1 0\n0 1 0 0 0 2 0 2 9 9 0.5 1\n"
      "0 1\n9 3 0 1 2 0.5\n";
  const Model model = good("extra.ply", header("ascii", elements) + body);
  EXPECT_EQ(corners_of(model), (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(model.mesh.normals[2], (Vec3{0, 0, 2}));
  EXPECT_EQ(model.mesh.texture[2], (std::array{0.5, 0.0}));
  EXPECT_EQ(model.materials[0].color, (std::array{0.8, 0.8, 0.8}));
}

TEST(Ply, TakesTextureCoordinatesOfFaces) {
  const Model model =
      good("wedges.ply",
           header("ascii", vertices(4, "float") + "element face 2\nproperty list uchar int vertex_indices\n"
                                                  "property list uchar float texcoord\n") +
               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
               "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0.5 0.5 0 0 0 1\n");
  ASSERT_EQ(model.mesh.triangles.size(), 2U);
  EXPECT_EQ(model.mesh.texture[model.mesh.triangles[0][2]], (std::array{1.0, 0.0}));
  EXPECT_EQ(model.mesh.texture[model.mesh.triangles[1][0]], (std::array{0.5, 0.5}));
}

TEST(Ply, UnrollsStrips) {
  const Model model = good(
      "strips.ply",
      header("ascii", vertices(5, "float") + "element tristrips 1\nproperty list int int vertex_indices\n") +
          "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 4 -1 0 1 2\n");
  EXPECT_EQ(model.mesh.triangles.size(), 4U);
  EXPECT_NEAR(area_of(model).z, 4.0, 1e-15);  // all face the same way
}

TEST(Ply, RefusesWhatIsWrong) {
  const std::string three = "0 0 0\n1 0 0\n0 1 0\n", text = header("ascii", vertices(3, "float") + faces);
  EXPECT_EQ(refusal("empty.ply", ""), "it has no header of a PLY file");
  EXPECT_EQ(refusal("head.ply", "ply\nformat ascii 1.0\n"), "it has no header of a PLY file");
  EXPECT_EQ(refusal("format.ply", header("middle_endian", "")),
            "its header is damaged: format middle_endian 1.0");
  EXPECT_EQ(refusal("type.ply", header("ascii", vertices(1, "complex"))),
            "its header is damaged: property complex x");
  EXPECT_EQ(refusal("flat.ply", header("ascii", "element vertex 1\nproperty float x\n") + "0\n"),
            "its vertices have no x, y and z");
  EXPECT_EQ(refusal("nan.ply", text + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n"),
            "among its 'vertex' is 'nan', which is no finite number");
  EXPECT_EQ(refusal("nan_b.ply", header("binary_little_endian", vertices(1, "float")) +
                                     bytes_of<float>({0, std::numeric_limits<double>::quiet_NaN(), 0})),
            "it has a number that is not finite");
  EXPECT_EQ(refusal("range.ply", text + three + "3 0 1 7\n"), "a face names the vertex 7, and there are 3");
  EXPECT_EQ(refusal("minus.ply", text + three + "3 0 1 -1\n"), "a face names the vertex -1, and there are 3");
  for (const auto& [number, named] : {std::pair{1e300, "1.0000000000000001e+300"},
                                      {1.5, "1.5"},
                                      {std::numeric_limits<double>::quiet_NaN(), "nan"}}) {
    EXPECT_EQ(
        refusal("double.ply",
                header("binary_little_endian",
                       vertices(3, "float") + "element face 1\nproperty list uchar double vertex_indices\n") +
                    std::string(36, '\0') + "\3" + bytes_of<double>({0, 1, number})),
        "a face names the vertex " + std::string(named) + ", and there are 3");
  }
  EXPECT_EQ(refusal("cut.ply", text + three), "it is cut short: it ends within its 1 of 'face'");
  EXPECT_EQ(refusal("cut_too.ply", text + "0 0 0\n1 0"), "it is cut short: it ends within its 3 of 'vertex'");
  EXPECT_EQ(refusal("list.ply", text + three + "1000000000 0 1 2\n"),
            "it is cut short: it ends within its 1 of 'face'");
  EXPECT_EQ(refusal("order.ply", header("ascii", faces + vertices(3, "float")) + "3 0 1 2\n" + three),
            "it has faces before its vertices, or no vertices");
  EXPECT_EQ(good("cloud.ply", header("ascii", vertices(3, "float")) + three).mesh.triangles.size(), 0U);
}

}  // namespace
}  // namespace backlight::test
