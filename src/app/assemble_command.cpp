#include "backlight/film/assemble.h"

#include <string>
#include <utility>

#include "commands.h"
#include "cube_faces.h"
#include "exit_codes.h"
#include "messages.h"

namespace backlight {

namespace {

int file_trouble(const std::string& message) {
  print_error(message);
  return exit_file_trouble;
}

int write_faces_of(const AssembleOptions& options) {
  const std::filesystem::path& file = options.parts.front();
  const auto info = read_exr_info(file);
  if (!info.ok()) return file_trouble(info.error());
  if (const auto cube = require_cubemap(file, info.value()); !cube.ok()) {
    print_error(cube.error());
    return exit_frame_failed;
  }
  const auto picture = read_exr(file);
  if (!picture.ok()) return file_trouble(picture.error());
  const auto to = options.output.empty() ? file : options.output / file.filename();
  const auto written = write_faces(to, picture.value());
  return written.ok() ? static_cast<int>(exit_success) : file_trouble(written.error());
}

}  // namespace

int run(const AssembleOptions& options) {
  if (options.faces) return write_faces_of(options);
  if (options.output.extension() != ".exr") {
    print_error("--output: images are written as OpenEXR: '" + options.output.string() +
                "' must end in .exr");
    return exit_usage;
  }
  std::vector<ImagePart> parts;
  for (const std::filesystem::path& file : options.parts) {
    auto info = read_exr_info(file);
    if (!info.ok()) return file_trouble(info.error());
    parts.push_back({file, std::move(info).value()});
  }
  const Assembly assembly = assemble_exr(options.output, parts, options.narrow);
  if (assembly.end == Assembly::End::written) return exit_success;
  print_error(assembly.message);
  return assembly.end == Assembly::End::misfit ? exit_frame_failed : exit_file_trouble;
}

}  // namespace backlight
