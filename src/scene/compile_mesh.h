// Meshes from files.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "compile_parts.h"

namespace backlight {

/// The file of an object whose shape is a mesh; null when it cannot be read, which is then reported.
std::shared_ptr<const LoadedModel> model_of(Compilation& c, const TableView& table);

/// Its shape, relative to the mesh's centre; nothing when something is wrong with it, which has been
/// reported.
std::optional<Shape> compile_mesh(Compilation& c, const TableView& table);

/// Reports a mesh that is not closed, under `key` of the table: it "cannot be ...".
void require_closed(const TableView& table, std::string_view key, const Mesh& mesh, const std::string& what);

/// Warns where a mesh without texture coordinates has a texture or a checker of the scene, of which it shows
/// one place.
void warn_without_texture_coordinates(const TableView& table, const Mesh& mesh);

/// Whether `material` says that the materials are those of the model's file.
bool has_materials_of_file(const TableView& table);

}  // namespace backlight
