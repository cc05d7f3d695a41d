#include "backlight/film/assemble.h"

#include <string>
#include <utility>

#include "commands.h"
#include "exit_codes.h"
#include "messages.h"

namespace backlight {

int run(const AssembleOptions& options) {
  if (options.output.extension() != ".exr") {
    print_error("--output: images are written as OpenEXR: '" + options.output.string() +
                "' must end in .exr");
    return exit_usage;
  }
  std::vector<ImagePart> parts;
  for (const std::filesystem::path& file : options.parts) {
    auto info = read_exr_info(file);
    if (!info.ok()) {
      print_error(info.error());
      return exit_file_trouble;
    }
    parts.push_back({file, std::move(info).value()});
  }
  const Assembly assembly = assemble_exr(options.output, parts, options.narrow);
  if (assembly.end == Assembly::End::written) return exit_success;
  print_error(assembly.message);
  return assembly.end == Assembly::End::misfit ? exit_frame_failed : exit_file_trouble;
}

}  // namespace backlight
