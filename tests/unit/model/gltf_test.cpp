// glTF 2 as it is found.
#include <limits>

#include "files.h"

namespace backlight::test {
namespace {

std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[bits >> (18U - 6U * static_cast<unsigned>(k)) & 63U];
  }
  return text;
}

const std::string places = bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
const std::string indices = bytes_of<std::uint16_t>({0, 1, 2, 2, 1, 3});

/// A square of two triangles, and what is to be otherwise.
struct Gltf {
  std::string buffer = places + indices + bytes_of<std::uint16_t>({0, 0, 65535, 0, 0, 65535, 65535, 65535});
  std::string uri;  // empty: the data itself
  std::string place = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")";
  std::string index = R"("bufferView":1,"componentType":5123,"count":6,"type":"SCALAR")";
  std::string attributes = R"("POSITION":0)";
  std::string primitive = R"("indices":1)";
  std::string nodes = R"({"mesh":0})";
  std::string views, accessors, more;  // further ones, each with a comma before it
  std::string scenes = R"([{"nodes":[0]}])";
  std::string version = "2.0";

  [[nodiscard]] std::string json(bool in_container = false) const {
    const std::string where =
        in_container
            ? ""
            : R"("uri":")" + (uri.empty() ? "data:application/octet-stream;base64," + base64(buffer) : uri) +
                  "\",";
    return R"({"asset":{"version":")" + version + R"("},"scene":0,"scenes":)" + scenes + R"(,"nodes":[)" +
           nodes + R"(],"buffers":[{)" + where + R"("byteLength":)" + std::to_string(buffer.size()) +
           R"(}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12},)"
           R"({"buffer":0,"byteOffset":60,"byteLength":16})" +
           views + R"(],"accessors":[{)" + place + "},{" + index + "}" + accessors +
           R"(],"meshes":[{"primitives":[{"attributes":{)" + attributes + "}" +
           (primitive.empty() ? "" : ",") + primitive + "}]}]" + more + "}";
  }
  [[nodiscard]] std::string container() const {
    std::string text = json(true), bytes = buffer;
    while (text.size() % 4 != 0) text += ' ';
    while (bytes.size() % 4 != 0) bytes += '\0';
    const auto word = [](std::size_t value) { return bytes_of<std::uint32_t>({static_cast<double>(value)}); };
    return "glTF" + word(2) + word(28 + text.size() + bytes.size()) + word(text.size()) + "JSON" + text +
           word(bytes.size()) + std::string("BIN\0", 4) + bytes;
  }
};

const std::vector<double> square{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0};

TEST(Gltf, FindsItsNumbersWhereverTheyAre) {
  Gltf file;
  EXPECT_EQ(corners_of(good("data.gltf", file.json())), square);
  EXPECT_EQ(corners_of(good("a.glb", file.container())), square);
  EXPECT_EQ(corners_of(good("named_so.gltf", file.container())), square);
  write_model("with space.bin", file.buffer);
  file.uri = "model_with%20space.bin";
  const Model model = good("outside.gltf", file.json());
  EXPECT_EQ(corners_of(model), square);
  ASSERT_EQ(model.files.size(), 1U);
  EXPECT_EQ(model.files[0].filename(), "model_with space.bin");
  EXPECT_EQ(model.materials[0].color, (std::array{0.8, 0.8, 0.8}));
}

TEST(Gltf, ReadsAllWaysOfLayingTriangles) {
  Gltf file;
  file.primitive = "";
  file.place = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")";
  EXPECT_EQ(good("plain.gltf", file.json()).mesh.triangles.size(), 1U);
  file = {};
  file.primitive = R"("mode":5)";
  EXPECT_EQ(area_of(good("strip.gltf", file.json())), (Vec3{0, 0, 2}));
  file.index = R"("bufferView":1,"componentType":5123,"count":4,"type":"SCALAR")";
  file.buffer = places + bytes_of<std::uint16_t>({0, 1, 2, 3, 0, 0}) + std::string(16, '\0');
  file.primitive = R"("indices":1,"mode":5)";
  EXPECT_EQ(area_of(good("strip_of_indices.gltf", file.json())), (Vec3{0, 0, 2}));
  file.buffer = places + bytes_of<std::uint16_t>({0, 1, 3, 2, 0, 0}) + std::string(16, '\0');
  file.primitive = R"("indices":1,"mode":6)";
  EXPECT_EQ(area_of(good("fan.gltf", file.json())), (Vec3{0, 0, 2}));
  file.primitive =
      R"("mode":1},{"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"mode":3)";
  EXPECT_EQ(good("lines.gltf", file.json()).left_out, 2U + 4U + 3U);
}

TEST(Gltf, TurnsNodesAndKeepsOutsidesOutside) {
  Gltf file;
  file.nodes =
      R"({"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,10,20,30,1],"children":[1]},{"mesh":0,"translation":[1,0,0]})";
  const std::vector<double> turned = corners_of(good("matrix.gltf", file.json()));
  EXPECT_EQ(std::vector<double>(turned.begin(), turned.begin() + 9),
            (std::vector<double>{10, 21, 30, 10, 22, 30, 9, 21, 30}));
  file.nodes = R"({"mesh":0,"translation":[1,2,3],"rotation":[0,0,0.6,0.8],"scale":[2,3,4]})";
  const Model model = good("parts.gltf", file.json());
  EXPECT_LT(glm::length(model.mesh.places[1] - Vec3{1 + 2 * 0.28, 2 + 2 * 0.96, 3}), 1e-14);
  EXPECT_NEAR(area_of(model).z, 12.0, 1e-13);
  file.nodes = R"({"mesh":0,"scale":[-1,1,1]})";
  file.buffer = places + indices + bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  file.views = R"(,{"buffer":0,"byteOffset":60,"byteLength":48})";
  file.accessors = R"(,{"bufferView":3,"componentType":5126,"count":4,"type":"VEC3"})";
  file.attributes = R"("POSITION":0,"NORMAL":2)";
  // Mirrored, it is seen from the other side of the mirror: its outside is still at +z.
  const Model mirrored = good("mirrored.gltf", file.json());
  EXPECT_EQ(area_of(mirrored), (Vec3{0, 0, 2}));
  for (const Vec3& normal : mirrored.mesh.normals) EXPECT_GT(normal.z, 0.0);
}

TEST(Gltf, ReadsSparseInterleavedAndQuantizedNumbers) {
  Gltf file;
  file.buffer = places + indices + bytes_of<std::uint16_t>({3, 0}) + bytes_of<float>({5, 6, 7});
  const std::string sparse =
      R"("sparse":{"count":1,"indices":{"bufferView":3,"componentType":5123},"values":{"bufferView":4}})";
  file.views = R"(,{"buffer":0,"byteOffset":60,"byteLength":2},{"buffer":0,"byteOffset":64,"byteLength":12})";
  file.place += "," + sparse;
  EXPECT_EQ(good("sparse.gltf", file.json()).mesh.places[3], (Vec3{5, 6, 7}));
  file.place = R"("componentType":5126,"count":4,"type":"VEC3",)" + sparse;
  const Model zeros = good("zeros.gltf", file.json());
  EXPECT_EQ(zeros.mesh.places[1], Vec3{0.0});
  EXPECT_EQ(zeros.mesh.places[3], (Vec3{5, 6, 7}));

  file = {};
  file.buffer.clear();
  for (const double x : {0.0, 1.0, 2.0, 3.0}) file.buffer += bytes_of<float>({x, 0, x * x, 0, 0, 1 + x});
  file.buffer += std::string("\0\1\2\2\1\3", 6) + std::string(10, '\0');
  file.views = R"(,{"buffer":0,"byteLength":96,"byteStride":24},{"buffer":0,"byteOffset":96,"byteLength":6})";
  file.place = R"("bufferView":3,"componentType":5126,"count":4,"type":"VEC3")";
  file.index = R"("bufferView":4,"componentType":5121,"count":6,"type":"SCALAR")";
  file.accessors = R"(,{"bufferView":3,"byteOffset":12,"componentType":5126,"count":4,"type":"VEC3"})";
  file.attributes = R"("POSITION":0,"NORMAL":2)";
  const Model woven = good("woven.gltf", file.json());
  EXPECT_EQ(woven.mesh.places[3], (Vec3{3, 0, 9}));
  EXPECT_EQ(woven.mesh.normals[3], (Vec3{0, 0, 4}));

  for (const bool normalized : {false, true}) {
    file = {};
    file.buffer = bytes_of<std::int16_t>({0, 0, 0, 0, 32767, 0, 0, 0, 0, -32768, 0, 0, 100, 50, 25, 0});
    file.buffer += std::string(16, '\0') + indices + std::string(16, '\0');
    file.views = R"(,{"buffer":0,"byteLength":32,"byteStride":8})";
    file.place = R"("bufferView":3,"componentType":5122,"count":4,"type":"VEC3")";
    if (normalized) file.place += R"(,"normalized":true)";
    file.more =
        R"(,"extensionsUsed":["KHR_mesh_quantization"],"extensionsRequired":["KHR_mesh_quantization"])";
    const Model model = good("quantized.gltf", file.json());
    EXPECT_EQ(model.mesh.places[1].x, normalized ? 1.0 : 32767.0);
    EXPECT_EQ(model.mesh.places[2].y, normalized ? -1.0 : -32768.0);
    EXPECT_EQ(model.mesh.places[3].z, normalized ? 25.0 / 32767.0 : 25.0);
  }
}

TEST(Gltf, TakesMaterialsAndHowTexturesAreLaid) {
  Gltf file;
  file.accessors = R"(,{"bufferView":2,"componentType":5123,"normalized":true,"count":4,"type":"VEC2"})";
  file.attributes = R"("POSITION":0,"TEXCOORD_0":2,"TEXCOORD_1":2)";
  file.primitive = R"("indices":1,"material":1},{"attributes":{"POSITION":0},"indices":1)";
  const std::string name = R"("images":[{"uri":"a%20picture.png"}],"textures":[{"source":0}])";
  file.more =
      "," + name +
      R"(,"materials":[{"name":"plain"},{"name":"bright","emissiveFactor":[1,0.5,0],)"
      R"("extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4}},)"
      R"("pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,1],"baseColorTexture":{"index":0,"texCoord":1,)"
      R"("extensions":{"KHR_texture_transform":{"offset":[0,1],"rotation":1.5707963267948966,"scale":[0.5,0.5]}}}}}])";
  const Model model = good("materials.gltf", file.json());
  EXPECT_EQ(model.mesh.members, (std::vector<std::uint32_t>{1, 1, 2, 2}));
  ASSERT_EQ(model.materials.size(), 3U);
  EXPECT_EQ(model.materials[0].color, (std::array{1.0, 1.0, 1.0}));
  EXPECT_EQ(model.materials[1].color, (std::array{0.1, 0.2, 0.3}));
  EXPECT_EQ(model.materials[1].emission, (std::array{4.0, 2.0, 0.0}));
  EXPECT_EQ(model.materials[1].texture.filename(), "a picture.png");
  EXPECT_EQ(model.materials[2].color, (std::array{0.8, 0.8, 0.8}));
  // The lower left quarter of the picture, as the extension's own example has it (v downwards).
  EXPECT_NEAR(model.mesh.texture[0][0], 0.0, 1e-15);
  EXPECT_NEAR(model.mesh.texture[0][1], 1.0, 1e-15);
  EXPECT_NEAR(model.mesh.texture[1][1], 0.5, 1e-15);  // u grows upwards
  EXPECT_NEAR(model.mesh.texture[2][0], 0.5, 1e-15);  // v grows to the right
}

TEST(Gltf, TakesPicturesWithinTheFile) {
  Gltf file;
  file.more =
      R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}},)"
      R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}},)"
      R"({"emissiveFactor":[1,1,1],"emissiveTexture":{"index":0},"pbrMetallicRoughness":{"baseColorTexture":{"index":1}}}],)"
      R"("images":[{"bufferView":1},{"uri":"data:image/png;base64,QUJD"}],"textures":[{"source":0},{"source":1}])";
  const Model model = good("pictures.gltf", file.json());
  EXPECT_EQ(model.materials[0].embedded_texture, indices);
  EXPECT_EQ(model.materials[1].embedded_texture, "ABC");
  EXPECT_EQ(model.materials[2].emission, (std::array{0.0, 0.0, 0.0}));
}

TEST(Gltf, RefusesWhatItCannotRead) {
  Gltf file;
  EXPECT_TRUE(refusal("empty.gltf", "").starts_with("it is no glTF"));
  EXPECT_TRUE(refusal("cut.gltf", file.json().substr(0, 300)).starts_with("it is no glTF"));
  EXPECT_EQ(refusal("list.gltf", "[]"), "it is no glTF");
  EXPECT_EQ(refusal("cut.glb", file.container().substr(0, 400)), "it is cut short");
  file.version = "1.0";
  EXPECT_EQ(refusal("old.gltf", file.json()), "it is of version 1.0 of glTF, not 2");
  for (const std::string extension :
       {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "EXT_mesh_gpu_instancing", "MADE_up"}) {
    file = {};
    file.more = R"(,"extensionsRequired":[")" + extension + "\"]";
    EXPECT_EQ(refusal("extension.gltf", file.json()),
              "it requires the extension " + extension + ", which is not supported: save it without");
  }
  file = {};
  file.nodes = R"({"children":[1]},{"mesh":0,"children":[0]})";
  EXPECT_EQ(refusal("circle.gltf", file.json()),
            "its node 0 is within itself, or in its scene more than once");
  file.nodes = R"({"children":[1,1]},{"mesh":0})";
  EXPECT_EQ(refusal("twice.gltf", file.json()),
            "its node 1 is within itself, or in its scene more than once");
  file.nodes = R"({"children":[7]})";
  EXPECT_EQ(refusal("child.gltf", file.json()), "it names number 7 of its nodes, and there are 1");
  file.nodes = R"({"mesh":0,"matrix":[1,2,3]})";
  EXPECT_EQ(refusal("matrix.gltf", file.json()), "its 'matrix' has not 16 numbers");
  file.nodes.clear();
  for (int i = 1; i <= 1002; ++i) file.nodes += R"({"children":[)" + std::to_string(i) + "]},";
  file.nodes += R"({"mesh":0})";
  EXPECT_EQ(refusal("deep.gltf", file.json()), "its nodes are nested more than 1000 deep");
  file = {};
  file.scenes = "[]";
  EXPECT_EQ(refusal("scene.gltf", file.json()), "it has no scene");
  file = {};
  file.uri = "model_gone.bin";
  EXPECT_TRUE(refusal("gone.gltf", file.json()).ends_with("model_gone.bin' cannot be opened"));
}

TEST(Gltf, RefusesNumbersThatAreNotThere) {
  Gltf file;
  file.buffer = places + bytes_of<std::uint16_t>({0, 1, 2, 2, 1, 9}) + std::string(16, '\0');
  EXPECT_EQ(refusal("range.gltf", file.json()), "a face names the vertex 9, and there are 4");
  file.index = R"("bufferView":1,"componentType":5122,"count":6,"type":"SCALAR")";
  file.buffer = places + bytes_of<std::int16_t>({0, 1, 2, 2, 1, -3}) + std::string(16, '\0');
  EXPECT_EQ(refusal("minus.gltf", file.json()), "a face names the vertex -3, and there are 4");
  file.index = R"("bufferView":1,"componentType":5126,"count":3,"type":"SCALAR")";
  file.buffer = places + bytes_of<float>({0, 1, 1.5}) + std::string(16, '\0');
  EXPECT_EQ(refusal("half.gltf", file.json()), "a face names the vertex 1.5, and there are 4");
  file.buffer =
      places + bytes_of<float>({0, 1, -std::numeric_limits<double>::infinity()}) + std::string(16, '\0');
  EXPECT_EQ(refusal("far.gltf", file.json()), "a face names the vertex -inf, and there are 4");
  file = {};
  file.buffer = bytes_of<float>({0, std::numeric_limits<double>::infinity(), 0}) + places.substr(12) +
                indices + std::string(16, '\0');
  EXPECT_EQ(refusal("infinite.gltf", file.json()), "it has a number that is not finite");
  file = {};
  file.place = R"("bufferView":0,"componentType":5126,"count":1000000000,"type":"VEC3")";
  EXPECT_EQ(refusal("huge.gltf", file.json()), "it says that it has 1000000000 vertices or indices");
  file.place = R"("bufferView":0,"componentType":5126,"count":5,"type":"VEC3")";
  EXPECT_EQ(refusal("more.gltf", file.json()), "it says that it has 5 numbers where there are less bytes");
  file.place = R"("componentType":5126,"count":5,"type":"VEC3")";
  EXPECT_EQ(refusal("none.gltf", file.json()), "an accessor has no numbers: its 'bufferView' is missing");
  file.place = R"("bufferView":0,"componentType":5126,"count":-1,"type":"VEC3")";
  EXPECT_EQ(refusal("minus.gltf", file.json()), "its 'count' is no whole number");
  file.place = R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC2")";
  EXPECT_EQ(refusal("type.gltf", file.json()), "an accessor has the type 'VEC2' where 3 numbers are wanted");
  file.place = R"("bufferView":0,"componentType":1,"count":4,"type":"VEC3")";
  EXPECT_EQ(refusal("kind.gltf", file.json()), "its numbers are of the type 1, which there is not");
  file.place = R"("bufferView":9,"componentType":5126,"count":4,"type":"VEC3")";
  EXPECT_EQ(refusal("view.gltf", file.json()), "it names number 9 of its bufferViews, and there are 3");
  file = {};
  file.views = R"(,{"buffer":0,"byteOffset":70,"byteLength":48})";
  file.place = R"("bufferView":3,"componentType":5126,"count":4,"type":"VEC3")";
  EXPECT_EQ(refusal("beyond.gltf", file.json()), "a view of a buffer ends beyond it");
  file = {};
  file.primitive = R"("indices":1,"material":0)";
  EXPECT_EQ(refusal("material.gltf", file.json()), "it names number 0 of its materials, and there are 0");
}

}  // namespace
}  // namespace backlight::test
