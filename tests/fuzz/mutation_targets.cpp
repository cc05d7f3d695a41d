#include "mutation_targets.h"

#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "backlight/base/files.h"
#include "backlight/film/assemble.h"
#include "backlight/film/compare.h"
#include "backlight/film/display.h"
#include "backlight/model/model_file.h"
#include "backlight/render/image_faults.h"
#include "backlight/render/image_identity.h"
#include "backlight/render/partial_file.h"
#include "backlight/render/render.h"
#include "backlight/scene/compile.h"
#include "backlight/scene/explain.h"
#include "backlight/scene/needs.h"
#include "backlight/scene/reader.h"
#include "backlight/surface/surface_set.h"

namespace backlight::fuzz {
namespace {

void require(bool fact, const char* what) {
  if (fact) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

void try_scene(const std::filesystem::path& file, const std::filesystem::path& folder) {
  // Shared by the inputs of a process, so that textures are decoded once.
  static ResourceCache& cache = *new ResourceCache;
  const auto text = read_file(file);
  require(text.ok(), "the input cannot be read");
  ReadResult read = read_scene_text(text.value(), "mutated.toml", {}, folder);
  require(read.description || read.diagnostics.has_errors(), "a scene is lost without a word");
  std::optional<Scene> scene;
  if (read.description) {
    ImageRequest request;
    request.resolution = {8, 6};
    request.samples = 1;
    request.aovs = {"Z", "doppler",  "emissionTime", "properTime", "P",
                    "N", "objectId", "unresolved",   "light",      "samples"};
    scene = compile(*read.description, request, cache, read.diagnostics);
    require(scene.has_value() != read.diagnostics.has_errors(), "a scene with errors, or none without");
  }
  for (const Diagnostic& diagnostic : read.diagnostics.all()) {
    require(!diagnostic.message.empty() && !format(diagnostic).empty(), "a message says nothing");
  }
  if (!scene) return;
  const Needs needs = needs_of(*scene);
  require(!explain(*read.description, *scene, needs).empty(), "nothing is explained");
  RenderSettings settings;
  settings.wavelengths = needs.wavelengths;
  std::atomic<bool> stop{false};
  const auto rendered = render_image(*scene, settings, stop, nullptr);
  require(rendered.has_value(), "no image");
  static_cast<void>(faults_of(rendered->image));
}

void try_resuming(const std::filesystem::path& file, const ExrInfo& info) {
  if (info.layout.channels.empty()) return;
  PartialImage partial(info.layout, 32, true);
  const auto* identity = info.header.find<std::string>(identity_attribute);
  static_cast<void>(read_partial(file, identity != nullptr ? *identity : "none", partial).ok());
}

void try_image(const std::filesystem::path& file) {
  const auto info = read_exr_info(file);
  static_cast<void>(read_whole_exr_info(file).ok());
  const auto picture = read_exr(file);
  require(info.ok() || !picture.ok(), "a picture without a header");
  if (!picture.ok()) return;
  const Image& image = picture.value().image;
  for (std::size_t view = 0; view < 2; ++view) static_cast<void>(display_image(image, {}, view).ok());
  static_cast<void>(compare_images(image, image, {}).ok());
  const std::filesystem::path whole = file.string() + ".whole.exr";
  const Assembly assembly = assemble_exr(whole, {{file, info.value()}}, false);
  require(assembly.end == Assembly::End::written || !assembly.message.empty(), "no word about an assembly");
  std::filesystem::remove(whole);
  try_resuming(file, info.value());
}

void try_texture(const std::filesystem::path& file) {
  const auto texture = load_texture(file);
  require(texture.ok() || !texture.error().empty(), "no word about a texture");
  if (texture.ok()) static_cast<void>(texture.value().sample(0.3, 0.7, TextureEdge::repeat));
}

void try_table(const std::filesystem::path& file) {
  static_cast<void>(read_stars(file).ok());
  auto table = read_spectrum(file);
  if (!table.ok()) return;
  const SpectrumOrError made =
      Spectrum::tabulated(std::move(table.value().wavelengths), std::move(table.value().values));
  require(made.spectrum.has_value() || !made.error.empty(), "no word about a spectrum");
}

void try_mesh(const std::filesystem::path& file) {
  auto read = read_model(file, true);
  require(read.ok() || !read.error().empty(), "no word about a mesh");
  if (!read.ok()) return;
  MeshData& data = read.value().mesh;
  for (const auto& triangle : data.triangles)
    for (const std::uint32_t corner : triangle) require(corner < data.places.size(), "a corner of nothing");
  for (const Vec3& place : data.places)
    require(std::isfinite(place.x + place.y + place.z), "a place that is nowhere");
  require(!read.value().materials.empty(), "no material");
  if (data.normals.empty()) add_smooth_normals(data, 0.7);
  const auto made = std::make_shared<const Mesh>(std::move(data));
  static_cast<void>(made->is_closed());
  const Shape shape = mesh(made);
  if (!problem(shape).empty()) return;
  SurfaceSet set;
  set.add(shape, Placement{});
  set.build();
  for (const Vec3 from : {Vec3{5, 4, 3}, Vec3{-3, 0.1, 0.2}, Vec3{0.01, 0.02, -1e3}}) {
    const Hit hit = set.nearest(from, -from);
    require(!hit.found() || hit.lambda > 0.0, "a hit behind");
    if (hit.found()) static_cast<void>(set.resolve(hit, from, -from));
  }
}

}  // namespace

void try_input(Kind kind, const std::filesystem::path& file, const std::filesystem::path& folder) {
  switch (kind) {
    case Kind::scene:
      return try_scene(file, folder);
    case Kind::image:
      return try_image(file);
    case Kind::texture:
      return try_texture(file);
    case Kind::table:
      return try_table(file);
    case Kind::mesh:
      return try_mesh(file);
  }
}

}  // namespace backlight::fuzz
