// PLY, STL and glTF by assimp, in single precision.
#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "read_model.h"

namespace backlight::models {
namespace {

/// Keeps a list of the files that are read.
class ListedFiles : public Assimp::DefaultIOSystem {
 public:
  explicit ListedFiles(std::set<std::string>& files) : files_(files) {}
  Assimp::IOStream* Open(const char* path, const char* mode) override {
    if (!std::filesystem::is_regular_file(path)) return nullptr;
    files_.insert(path);
    return DefaultIOSystem::Open(path, mode);
  }

 private:
  std::set<std::string>& files_;
};

using Matrix = std::array<std::array<double, 4>, 3>;

Matrix times(const Matrix& a, const aiMatrix4x4& b) {
  const double other[4][4] = {
      {b.a1, b.a2, b.a3, b.a4}, {b.b1, b.b2, b.b3, b.b4}, {b.c1, b.c2, b.c3, b.c4}, {b.d1, b.d2, b.d3, b.d4}};
  Matrix product{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      for (std::size_t k = 0; k < 4; ++k) product[i][j] += a[i][k] * other[k][j];
  return product;
}

std::array<double, 3> place_in(const Matrix& m, const aiVector3D& v) {
  std::array<double, 3> place{};
  for (std::size_t i = 0; i < 3; ++i) place[i] = m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z + m[i][3];
  return place;
}

/// By the matrix of cofactors, as normals go; of a mirrored one, outwards still.
std::array<double, 3> normal_in(const Matrix& m, const aiVector3D& v) {
  std::array<double, 3> normal{};
  const double n[3] = {v.x, v.y, v.z};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto &b = m[(i + 1) % 3], &c = m[(i + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = (j + 1) % 3, l = (j + 2) % 3;
      normal[i] += (b[k] * c[l] - b[l] * c[k]) * n[j];
    }
  }
  return normal;
}

double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

class Reader {
 public:
  Reader(const aiScene& scene, bool normals, Read& read) : scene_(scene), normals_(normals), read_(read) {}

  void read_nodes() {
    constexpr Matrix unit{{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}, {0.0, 0.0, 1.0, 0.0}}};
    read_.corners.has_normals = true;
    visit(*scene_.mRootNode, unit, 0);
  }

 private:
  void visit(const aiNode& node, const Matrix& outer, int depth) {
    constexpr int deepest = 1000;
    if (depth > deepest) throw std::runtime_error("its nodes are nested more than 1000 deep");
    const Matrix here = times(outer, node.mTransformation);
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], here);
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], here, depth + 1);
  }

  void add(const aiMesh& mesh, const Matrix& matrix) {
    const bool has_normals = normals_ && mesh.HasNormals();
    read_.corners.has_normals = read_.corners.has_normals && has_normals;
    const bool has_texture = mesh.HasTextureCoords(0);
    read_.corners.has_texture = read_.corners.has_texture || has_texture;
    const bool mirrored = determinant(matrix) < 0.0;
    std::vector<std::uint32_t> number_of(mesh.mNumVertices);
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      Corner corner;
      corner.place = place_in(matrix, mesh.mVertices[i]);
      if (has_normals) corner.normal = normal_in(matrix, mesh.mNormals[i]);
      if (has_texture) corner.texture = {mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y};
      // A normal that is not a number is none.
      if (has_normals && !std::isfinite(corner.normal[0] + corner.normal[1] + corner.normal[2]))
        corner.normal = {};
      number_of[i] = read_.corners.add(corner);
    }
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) {
        ++read_.left_out;
        continue;
      }
      std::uint32_t corners[3];
      for (unsigned k = 0; k < 3; ++k) {
        if (face.mIndices[k] >= mesh.mNumVertices) {
          throw std::runtime_error("a face names the vertex " + std::to_string(face.mIndices[k]) +
                                   ", and there are " + std::to_string(mesh.mNumVertices));
        }
        corners[k] = number_of[face.mIndices[k]];
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      read_.indices.insert(read_.indices.end(), corners, corners + 3);
      read_.materials_of_triangles.push_back(std::min(mesh.mMaterialIndex, scene_.mNumMaterials));
      if (read_.materials_of_triangles.size() > most_triangles)
        throw std::runtime_error("it has more than " + std::to_string(most_triangles) + " triangles");
    }
  }

  const aiScene& scene_;
  bool normals_;
  Read& read_;
};

void take(const aiMaterial& given, const char* key, unsigned type, unsigned index,
          std::array<double, 3>& into) {
  aiColor4D color;
  if (aiGetMaterialColor(&given, key, type, index, &color) != AI_SUCCESS) return;
  into = {color.r, color.g, color.b};
}

/// A texture that is within the model's file: "*0", or its name.
std::string embedded(const aiScene& scene, const std::string& name) {
  const aiTexture* texture = scene.GetEmbeddedTexture(name.c_str());
  if (texture == nullptr) return {};
  if (texture->mHeight != 0)
    throw std::runtime_error("it has a texture of bare texels in it, which is not supported");
  return {reinterpret_cast<const char*>(texture->pcData), texture->mWidth};
}

Material material_of(const aiScene& scene, const aiMaterial& given) {
  Material material;
  material.name = given.GetName().C_Str();
  take(given, AI_MATKEY_COLOR_DIFFUSE, material.color);
  take(given, AI_MATKEY_BASE_COLOR, material.color);
  take(given, AI_MATKEY_COLOR_EMISSIVE, material.emission);
  aiString path;
  for (const aiTextureType type : {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE}) {
    if (given.GetTexture(type, 0, &path) != AI_SUCCESS) continue;
    material.embedded = embedded(scene, path.C_Str());
    if (material.embedded.empty()) material.texture = path.C_Str();
    break;
  }
  return material;
}

}  // namespace

Read read_by_assimp(const std::string& path, bool normals) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".ply") check_ply_header(path);
  std::set<std::string> files;
  Assimp::Importer importer;
  importer.SetIOHandler(new ListedFiles(files));  // which it deletes
  importer.SetPropertyBool(AI_CONFIG_PP_PTV_KEEP_HIERARCHY, true);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string text = importer.GetErrorString();
    throw std::runtime_error(text.empty() ? "it cannot be read" : text.substr(0, text.find('\n')));
  }
  Read read;
  // The normals of an STL file are those of its facets.
  Reader(*scene, normals && ending != ".stl", read).read_nodes();
  for (unsigned i = 0; i < scene->mNumMaterials; ++i)
    read.materials.push_back(material_of(*scene, *scene->mMaterials[i]));
  read.materials.emplace_back();
  files.erase(path);
  read.files.assign(files.begin(), files.end());
  return read;
}

}  // namespace backlight::models
