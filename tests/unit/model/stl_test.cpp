// STL as it is found.
#include <limits>

#include "files.h"

namespace backlight::test {
namespace {

const std::vector<double> triangle{0, 0, 0, 1, 0, 0, 0, 1, 0};

std::string facet(double z) {
  return bytes_of<float>({0, 0, 0, 0, 0, z, 1, 0, z, 0, 1, z}) + std::string(2, '\0');
}

std::string binary(const std::string& head, std::uint32_t announced, const std::string& body) {
  std::string start = head;
  start.resize(80, ' ');
  return start + bytes_of<std::uint32_t>({static_cast<double>(announced)}) + body;
}

TEST(Stl, ReadsTextInEveryDress) {
  const std::string corners = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  const std::string one = "facet normal 0 0 1\nouter loop\n" + corners + "endloop\nendfacet\n";
  EXPECT_EQ(corners_of(good("a.stl", "solid a part\n" + one + "endsolid a part\n")), triangle);
  EXPECT_EQ(corners_of(good("bare.stl", "solid\n" + one + "endsolid")), triangle);
  EXPECT_EQ(corners_of(good("upper.stl",
                            "SOLID A\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1.0E+00 0 0\n"
                            "VERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID\n")),
            triangle);
  EXPECT_EQ(corners_of(good("spaces.stl",
                            "  solid\r\n\tfacet   normal  nan nan nan\r\n\r\n outer  loop vertex  0 0   0\r\n"
                            "vertex 1 0 0\tvertex 0 1 0\r\nendloop\r\nendfacet endsolid\r\n")),
            triangle);
  EXPECT_EQ(corners_of(
                good("normal.stl", "solid\nfacet\nouter loop\n" + corners + "endloop\nendfacet\nendsolid\n")),
            triangle);
  EXPECT_EQ(good("two.stl", "solid a\n" + one + "endsolid a\nsolid b\n" + one + one + "endsolid b\n")
                .mesh.triangles.size(),
            3U);
}

TEST(Stl, TellsBinaryByItsSize) {
  const std::string two = facet(0) + facet(1);
  for (const std::string head : {"made by hand", "solid made by hand", "COLOR=abcd", ""}) {
    const Model model = good("binary.stl", binary(head, 2, two));
    ASSERT_EQ(model.mesh.triangles.size(), 2U) << head;
    EXPECT_EQ(model.mesh.places.size(), 6U);
    EXPECT_EQ(model.materials[0].color, (std::array{0.8, 0.8, 0.8}));
  }
  EXPECT_EQ(good("shared.stl", binary("", 2, facet(0) + facet(0))).mesh.places.size(), 3U);
  EXPECT_EQ(good("tail.stl", binary("", 2, two + "and more")).mesh.triangles.size(), 2U);
}

TEST(Stl, RefusesWhatIsWrong) {
  EXPECT_EQ(refusal("empty.stl", ""), "it is no STL file");
  EXPECT_EQ(refusal("other.stl", "something else"), "it is no STL file");
  EXPECT_EQ(refusal("cut_binary.stl", binary("", 2, facet(0))),
            "it says that it has 2 triangles, and has 134 bytes");
  EXPECT_EQ(refusal("huge.stl", binary("", 1000000000, facet(0))),
            "it says that it has 1000000000 triangles, and has 134 bytes");
  EXPECT_EQ(refusal("infinite.stl", binary("", 1, facet(std::numeric_limits<double>::infinity()))),
            "it has a number that is not finite");
  EXPECT_EQ(refusal("cut.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0"),
            "line 5: expected three finite numbers");
  EXPECT_EQ(refusal("cut_too.stl",
                    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                    "endloop\nendfacet\n"),
            "it is cut short: it does not end with 'endsolid'");
  EXPECT_EQ(refusal("nan.stl", "solid\nfacet\nouter loop\nvertex 0 nan 0\n"),
            "line 4: expected three finite numbers");
  EXPECT_EQ(refusal("words.stl", "solid\nfacets\n"), "line 2: expected 'facet' or 'endsolid'");
}

}  // namespace
}  // namespace backlight::test
