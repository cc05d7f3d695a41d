// The options of render and check.
#include <cmath>
#include <memory>

#include "command_table.h"

namespace backlight {
namespace {

struct SceneFlags {
  SceneOptions options;
  bool quiet = false;
  bool verbose = false;
};

Result<SceneOptions> scene_of(const SceneFlags& flags, const std::vector<std::string>& operands) {
  if (operands.empty()) return Failure{"no scene file is given"};
  if (operands.size() > 1) return Failure{"more than one scene file is given: '" + operands[1] + "'"};
  SceneOptions scene = flags.options;
  scene.file = operands.front();
  return scene;
}

void add_scene_rows(CommandTable& table, SceneOptions& scene) {
  RowGroup group(table, "Scene");
  group
      .value("-D,--set", "PATH=VALUE",
             "change a value of the scene, as in -D camera.fov=40 or -D "
             "'object.tram.velocity=[0.9,0,0]'; may be repeated",
             parse_override, [&scene](std::string one) { scene.overrides.push_back(std::move(one)); })
      .every = true;
  group.value("--camera", "NAME", "the camera to look through, where the scene has several", parse_text,
              scene.request.camera);
}

// An existing folder may have any name.
Result<OutputPattern> output_of(const std::string& text) {
  std::error_code error;
  return std::filesystem::is_directory(text, error) ? OutputPattern::literal(text)
                                                    : OutputPattern::parse(text);
}

void add_output_rows(CommandTable& table, RenderOptions& options) {
  RowGroup group(table, "Output");
  group.value("-o,--output", "PATTERN",
              "file to write, or a folder for it; #### or %04d stands for the frame number (one # means four "
              "digits). Default: the scene's name with .exr in the current folder. Folders are made",
              output_of, options.output);
  group.flag("--png", options.png, "write a PNG to look at beside each EXR");
  add_display_rows(group, options.display, "--png");
  add_label_row(group, options.label, "--png");
  group.value("--stats", "FILE",
              "write one JSON object for each image, a line each: time, rays, pixels that are not finite... "
              "(- for standard output)",
              parse_text, options.statistics);
}

void add_film_rows(CommandTable& table, ImageRequest& request, RenderOptions& options) {
  RowGroup group(table, "Picture");
  group.value("-r,--resolution", "WxH", "size of the image in pixels, as in 1280x720", parse_size,
              request.resolution);
  group.value(
      "--crop", "X0,Y0,X1,Y1",
      "render only the pixels with X0 <= x < X1 and Y0 <= y < Y1, y down; they are the same as in the whole "
      "image, and its size is kept in the file",
      parse_crop, options.crop);
  group.value("-s,--samples", "N", "samples in each pixel; 1 is exactly its centre", whole<int>(1, 1048576),
              request.samples);
  group.value("--tolerance", "E",
              "error of the image, as in 0.005 (1 is from black to white): samples and wavelengths are "
              "chosen to meet it, whatever the scene says; -s and --wavelengths still fix their number",
              parse_number, request.tolerance);
  group.value("--wavelengths", "N", "wavelengths that carry a colour where colours shift",
              whole<int>(4, 1024), request.wavelengths);
  group.value("--seed", "N", "another number gives other sample positions", whole<unsigned>(0, 4294967295),
              request.seed);
  group
      .value("--aov", "LIST",
             "data channels besides the colour, with commas between: Z, doppler, emissionTime, properTime, "
             "P, N, "
             "objectId, unresolved, light, samples, mirror, lampTime; or all, or none",
             parse_aovs, request.aovs)
      .words = aov_words();
}

void add_animation_rows(CommandTable& table, RenderOptions& options) {
  RowGroup group(table, "Animation");
  group.value("-f,--frames", "RANGE",
              "frames to render, as in 7 or 1-100 or 1-100x2,150; default: the scene's", parse_frames,
              options.frames);
  group.value("--time", "T", "one image at the scene time T, in seconds", parse_number, options.time);
}

// Four times in this time a claim is renewed.
Result<std::chrono::milliseconds> seconds_of_expiry(const std::string& text) {
  const auto seconds = parse_number(text);
  if (!seconds.ok()) return seconds.failure();
  if (!(seconds.value() >= 0.1 && seconds.value() <= 86400.0))
    return Failure{"expected a number of seconds from 0.1 to 86400"};
  return std::chrono::milliseconds(std::llround(1000.0 * seconds.value()));
}

void add_again_rows(CommandTable& table, RenderOptions& options) {
  RowGroup group(table, "Going on, and sharing the work");
  group.flag(
      "--skip-existing,--no-clobber", options.skip_existing,
      "skip an image whose file is complete and was made from the same scene, files, settings and version; "
      "a file that was not is replaced");
  group.flag(
      "--resume", options.resume,
      "go on where an earlier run was stopped: skip as --skip-existing does, and finish NAME.partial.exr, "
      "to the same bytes as without the stop");
  group.flag(
      "--claim", options.claim,
      "share the images with other processes, on this machine or others, that render into the same folder: "
      "each is made once. NAME.exr.claim marks an image in hand. Skips as --skip-existing does, and waits "
      "at the end for the images of others");
  group.value("--claim-expires", "SECONDS",
              "take over a claim that this process has not seen renewed for so long; default 60. A process "
              "of this machine that is gone is not waited for",
              seconds_of_expiry, options.claim_expiry);
}

void add_run_rows(CommandTable& table, RenderOptions& options) {
  RowGroup group(table, "Run");
  group.value("-t,--threads", "N", "threads to use; default: the CPUs that this process may use",
              whole<int>(1, 65536), options.threads);
  group.choice<ProgressStyle>("--progress", "STYLE",
                              "auto (a bar on a terminal, else lines), bar, lines, json or none; on stderr",
                              {{"auto", ProgressStyle::automatic},
                               {"bar", ProgressStyle::bar},
                               {"lines", ProgressStyle::lines},
                               {"json", ProgressStyle::json},
                               {"none", ProgressStyle::none}},
                              options.progress);
  group.flag("--dry-run", options.dry_run, "check the scene and print the files that would be written");
  group.flag("--list-frames", options.list_frames,
             "the same, with the frame number and a tab before each file");
}

}  // namespace

CommandTable render_table() {
  struct State {
    SceneFlags scene;
    RenderOptions options;
    bool half = false;
    bool single = false;
  };
  const auto state = std::make_shared<State>();
  CommandTable table{{"render", "Trace the images of a scene into OpenEXR files.",
                      "[render] SCENE.toml [options]", "SCENE.toml"}};
  add_output_rows(table, state->options);
  RowGroup output(table, "Output");
  output.flag("--half", state->half, "16-bit colour, the default; 32-bit if a value is too large for it");
  output.flag("--float", state->single, "32-bit colour");
  add_film_rows(table, state->scene.options.request, state->options);
  add_animation_rows(table, state->options);
  add_again_rows(table, state->options);
  add_scene_rows(table, state->scene.options);
  add_run_rows(table, state->options);
  add_verbosity(table, state->scene.quiet, state->scene.verbose);
  table.finish = [state](const std::vector<std::string>& operands) -> Result<Command> {
    RenderOptions options = state->options;
    if (state->half && state->single) return Failure{"--half: not together with --float"};
    if (options.frames && options.time) return Failure{"--time: not together with --frames"};
    if (auto display = check_display(options.display); !display.ok()) return display.failure();
    if (state->single) options.storage = ColourStorage::always_float;
    options.skip_existing |= options.resume || options.claim;
    auto scene = scene_of(state->scene, operands);
    if (!scene.ok()) return scene.failure();
    options.scene = std::move(scene).value();
    const auto verbosity = verbosity_of(state->scene.quiet, state->scene.verbose);
    if (!verbosity.ok()) return verbosity.failure();
    options.verbosity = verbosity.value();
    return Command{std::move(options)};
  };
  return table;
}

CommandTable check_table() {
  const auto flags = std::make_shared<SceneFlags>();
  CommandTable table{{"check", "Look for mistakes in a scene and explain what it needs; render nothing.",
                      "check SCENE.toml [options]", "SCENE.toml"}};
  add_scene_rows(table, flags->options);
  add_quiet(table, flags->quiet);
  table.finish = [flags](const std::vector<std::string>& operands) -> Result<Command> {
    auto scene = scene_of(*flags, operands);
    if (!scene.ok()) return scene.failure();
    return Command{
        CheckOptions{std::move(scene).value(), flags->quiet ? Verbosity::quiet : Verbosity::normal}};
  };
  return table;
}

}  // namespace backlight
