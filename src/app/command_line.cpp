// The only file that includes CLI11, which takes a compiler longer than the rest of the folder.
// Longer than 400 lines: CLI11's options are declared in one place.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>

#include "backlight/base/diagnostics.h"
#include "help_text.h"
#include "manual.h"
#include "option_values.h"
#include "options.h"

namespace backlight {
namespace {

constexpr std::array command_names{"render", "check",    "compare", "view",  "info",
                                   "probe",  "assemble", "schema",  "manual"};

// Help that reads like a manual page: names, value and meaning in columns, wrapped at 100 characters.
class HelpFormatter : public CLI::Formatter {
 public:
  explicit HelpFormatter(std::string usage) : usage_(std::move(usage)) {}

  [[nodiscard]] const std::string& usage() const { return usage_; }

  std::string make_usage(const CLI::App* /*app*/, std::string /*name*/) const override {
    return "\nUsage: " + usage_ + "\n";
  }
  std::string make_positionals(const CLI::App* /*app*/) const override { return {}; }

  std::string make_option(const CLI::Option* option, bool /*is_positional*/) const override {
    std::string names = option->get_name(false, true);
    if (const std::size_t comma = names.find(','); comma != std::string::npos) names.insert(comma + 1, " ");
    if (!names.starts_with("--")) return help_row("  " + names + value_of(option), option->get_description());
    return help_row("      " + names + value_of(option), option->get_description());
  }

 private:
  static std::string value_of(const CLI::Option* option) {
    return option->get_type_name().empty() ? "" : " " + option->get_type_name();
  }
  std::string usage_;
};

std::unique_ptr<CLI::App> make_app(const std::string& name, const std::string& what,
                                   const std::string& usage) {
  auto app = std::make_unique<CLI::App>(what, "backlight " + name);
  app->formatter(std::make_shared<HelpFormatter>("backlight " + usage));
  app->allow_extras();  // unknown flags are reported by unknown_argument()
  app->option_defaults()->take_last();
  app->set_help_flag();
  return app;
}

// An option whose value is read by `read`, from a text to a Result.
template <class Read, class Set>
CLI::Option* add_value(CLI::App& app, const char* names, const char* value, const std::string& help,
                       Read read, Set set) {
  const std::string all = names;
  const std::string name = all.substr(all.rfind(',') + 1);
  return app
      .add_option_function<std::string>(
          names,
          [name, read, set](const std::string& text) {
            auto result = read(text);
            if (!result.ok()) throw CLI::ValidationError(name, result.error());
            set(std::move(result).value());
          },
          help)
      ->type_name(value);
}

auto whole(std::int64_t least, std::int64_t most) {
  return [least, most](const std::string& text) { return parse_whole(text, least, most); };
}

// An existing folder may have any name.
Result<OutputPattern> output_of(const std::string& text) {
  std::error_code error;
  return std::filesystem::is_directory(text, error) ? OutputPattern::literal(text)
                                                    : OutputPattern::parse(text);
}

// Four times in this time a claim is renewed.
Result<std::chrono::milliseconds> seconds_of_expiry(const std::string& text) {
  const auto seconds = parse_number(text);
  if (!seconds.ok()) return seconds.failure();
  if (!(seconds.value() >= 0.1 && seconds.value() <= 86400.0)) {
    return Failure{"expected a number of seconds from 0.1 to 86400"};
  }
  return std::chrono::milliseconds(std::llround(1000.0 * seconds.value()));
}

// Reads one of these words.
template <class Value>
auto choice(std::vector<std::pair<std::string, Value>> choices) {
  return [choices = std::move(choices)](const std::string& text) -> Result<Value> {
    std::vector<std::string> names;
    for (const auto& [name, value] : choices) {
      if (name == text) return value;
      names.push_back(name);
    }
    return not_one_of(names, text);
  };
}

// An option that reads one of these words. They go into a remark on its values that CLI11 does not act upon,
// and words_of() takes them out again: for completion.
constexpr const char* words_remark = "words";

template <class Value, class Set>
CLI::Option* add_choice(CLI::App& app, const char* names, const char* value, const std::string& help,
                        std::vector<std::pair<std::string, Value>> choices, Set set) {
  std::string words;
  for (const auto& [name, one] : choices) words += (words.empty() ? "" : " ") + name;
  CLI::Validator remark([](std::string& /*text*/) { return std::string(); }, words, words_remark);
  return add_value(app, names, value, help, choice(std::move(choices)), set)->check(remark.active(false));
}

std::vector<std::string> words_of(CLI::Option& option) {
  std::string words;
  try {
    CLI::Validator remark = *option.get_validator(words_remark);
    words = remark.active().get_description();
  } catch (const CLI::OptionNotFound&) {
  }
  std::istringstream list(words);
  return {std::istream_iterator<std::string>(list), {}};
}

// One command: its options, where their values go, and what is still to check when all are read.
struct Parser {
  std::unique_ptr<CLI::App> app;
  std::function<Command()> finish;  ///< throws CLI::ValidationError
};

CLI::Option* add_flag(CLI::App& app, const char* names, bool& value, const char* help) {
  return app.add_flag(names, value, help);
}

struct SceneFlags {
  SceneOptions options;
  std::vector<std::string> files;
  bool quiet = false;
  bool verbose = false;

  [[nodiscard]] Verbosity verbosity() const {
    if (quiet && verbose) throw CLI::ValidationError("--quiet", "not together with --verbose");
    return quiet ? Verbosity::quiet : verbose ? Verbosity::verbose : Verbosity::normal;
  }

  [[nodiscard]] SceneOptions scene() const {
    if (files.empty()) throw CLI::ValidationError("", "no scene file is given");
    if (files.size() > 1)
      throw CLI::ValidationError("", "more than one scene file is given: '" + files[1] + "'");
    for (const std::string& text : options.overrides) {
      if (const auto checked = parse_override(text); !checked.ok())
        throw CLI::ValidationError("--set", checked.error());
    }
    SceneOptions scene = options;
    scene.file = files.front();
    return scene;
  }
};

void add_scene_flags(CLI::App& app, SceneFlags& flags) {
  app.add_option("SCENE.toml", flags.files);
  app.add_option(
         "-D,--set", flags.options.overrides,
         "change a value of the scene, as in -D camera.fov=40 or -D 'object.tram.velocity=[0.9,0,0]'; may be "
         "repeated")
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false)
      ->take_all()
      ->group("Scene");
  add_value(app, "--camera", "NAME", "the camera to look through, where the scene has several", parse_text,
            [&flags](std::string name) { flags.options.request.camera = std::move(name); })
      ->group("Scene");
}

void add_verbosity(CLI::App& app, bool& quiet, bool* verbose) {
  add_flag(app, "-q,--quiet", quiet, "say nothing but errors")->group("Other");
  if (verbose != nullptr) add_flag(app, "-v,--verbose", *verbose, "say more about each step")->group("Other");
}

void add_film_flags(CLI::App& app, ImageRequest& request, RenderOptions& options) {
  const char* group = "Picture";
  add_value(app, "-r,--resolution", "WxH", "size of the image in pixels, as in 1280x720", parse_size,
            [&request](std::pair<int, int> size) { request.resolution = size; })
      ->group(group);
  add_value(
      app, "--crop", "X0,Y0,X1,Y1",
      "render only the pixels with X0 <= x < X1 and Y0 <= y < Y1, y down; they are the same as in the whole "
      "image, and its size is kept in the file",
      parse_crop, [&options](PixelBox box) { options.crop = box; })
      ->group(group);
  add_value(app, "-s,--samples", "N", "samples in each pixel; 1 is exactly its centre", whole(1, 1048576),
            [&request](std::int64_t count) { request.samples = static_cast<int>(count); })
      ->group(group);
  add_value(app, "--tolerance", "E",
            "error of the image, as in 0.005 (1 is from black to white): samples and wavelengths are "
            "chosen to meet it, whatever the scene says; -s and --wavelengths still fix their number",
            parse_number, [&request](double tolerance) { request.tolerance = tolerance; })
      ->group(group);
  add_value(app, "--wavelengths", "N", "wavelengths that carry a colour where colours shift", whole(4, 1024),
            [&request](std::int64_t count) { request.wavelengths = static_cast<int>(count); })
      ->group(group);
  add_value(app, "--seed", "N", "another number gives other sample positions", whole(0, 4294967295),
            [&request](std::int64_t seed) { request.seed = static_cast<unsigned>(seed); })
      ->group(group);
  add_value(
      app, "--aov", "LIST",
      "data channels besides the colour, with commas between: Z, doppler, emissionTime, properTime, P, N, "
      "objectId, unresolved, light, samples, mirror, lampTime; or all, or none",
      parse_aovs, [&request](std::vector<std::string> names) { request.aovs = std::move(names); })
      ->group(group);
}

// The same for view and for the PNGs of render, where they stand in the group of `needs`.
void add_display_flags(CLI::App& app, DisplayChoice& display, const char* group, CLI::Option* needs) {
  const auto finish = [&](CLI::Option* option) {
    option->group(group);
    if (needs != nullptr) option->needs(needs);
  };
  const std::string of_pngs = needs != nullptr ? "of the PNGs: " : "";
  finish(
      app.add_option_function<std::string>(
             "--exposure",
             [&display](const std::string& text) {
               if (text == "auto") {
                 display.automatic_exposure = true;
                 return;
               }
               const auto stops = parse_number(text);
               if (!stops.ok()) throw CLI::ValidationError("--exposure", stops.error() + " or auto");
               display.exposure_stops = stops.value();
             },
             of_pngs +
                 "brighten by a factor of 2 a stop, negative darkens; auto shows the log-average luminance "
                 "as middle grey")
          ->type_name("STOPS"));
  finish(add_choice<std::optional<ToneCurve>>(
      app, "--tone", "CURVE",
      of_pngs + "what becomes of light beyond white. auto (the default): none if next to "
                "nothing is, else reinhard, or "
                "drago where many powers of ten are, exposed so that nothing is cut, and named "
                "on stderr; none: cut; "
                "drago: logarithm, exposed by itself; reinhard; log",
      {{"auto", std::nullopt},
       {"none", ToneCurve::none},
       {"drago", ToneCurve::drago},
       {"reinhard", ToneCurve::reinhard},
       {"log", ToneCurve::logarithmic}},
      [&display](std::optional<ToneCurve> curve) { display.tone = curve; }));
  finish(add_value(app, "--white", "L",
                   of_pngs +
                       "luminance that the curve shows as white, after exposure; default 1000, for drago the "
                       "greatest",
                   parse_number, [&display](double white) { display.white = white; }));
}

void check_display(const DisplayChoice& display) {
  if (display.white && !(*display.white > 0.0))
    throw CLI::ValidationError("--white", "expected a number greater than 0");
}

void add_output_flags(CLI::App& app, RenderOptions& options) {
  const char* group = "Output";
  add_value(app, "-o,--output", "PATTERN",
            "file to write, or a folder for it; #### or %04d stands for the frame number (one # means four "
            "digits). "
            "Default: the scene's name with .exr in the current folder. Folders are made",
            output_of, [&options](OutputPattern pattern) { options.output = std::move(pattern); })
      ->group(group);
  CLI::Option* png = add_flag(app, "--png", options.png, "write a PNG to look at beside each EXR");
  png->group(group);
  add_display_flags(app, options.display, group, png);
  add_value(app, "--stats", "FILE",
            "write one JSON object for each image, a line each: time, rays, pixels that are not finite... "
            "(- for standard output)",
            parse_text, [&options](std::string file) { options.statistics = file; })
      ->group(group);
}

void add_animation_flags(CLI::App& app, RenderOptions& options) {
  const char* group = "Animation";
  add_value(app, "-f,--frames", "RANGE",
            "frames to render, as in 7 or 1-100 or 1-100x2,150; default: the scene's", parse_frames,
            [&options](std::vector<int> frames) { options.frames = std::move(frames); })
      ->group(group);
  add_value(app, "--time", "T", "one image at the scene time T, in seconds", parse_number,
            [&options](double time) { options.time = time; })
      ->group(group);
}

void add_again_flags(CLI::App& app, RenderOptions& options) {
  const char* group = "Going on, and sharing the work";
  add_flag(
      app, "--skip-existing,--no-clobber", options.skip_existing,
      "skip an image whose file is complete and was made from the same scene, files, settings and version; "
      "a file that was not is replaced")
      ->group(group);
  add_flag(
      app, "--resume", options.resume,
      "go on where an earlier run was stopped: skip as --skip-existing does, and finish NAME.partial.exr, "
      "to the same bytes as without the stop")
      ->group(group);
  add_flag(
      app, "--claim", options.claim,
      "share the images with other processes, on this machine or others, that render into the same folder: "
      "each is made once. NAME.exr.claim marks an image in hand. Skips as --skip-existing does, and waits "
      "at the end for the images of others")
      ->group(group);
  add_value(app, "--claim-expires", "SECONDS",
            "take over a claim that this process has not seen renewed for so long; default 60. A process of "
            "this machine that is gone is not waited for",
            seconds_of_expiry,
            [&options](std::chrono::milliseconds expiry) { options.claim_expiry = expiry; })
      ->group(group);
}

void add_run_flags(CLI::App& app, RenderOptions& options) {
  const char* group = "Run";
  add_value(app, "-t,--threads", "N", "threads to use; default: the CPUs that this process may use",
            whole(1, 65536), [&options](std::int64_t count) { options.threads = static_cast<int>(count); })
      ->group(group);
  add_choice<ProgressStyle>(app, "--progress", "STYLE",
                            "auto (a bar on a terminal, else lines), bar, lines, json or none; on stderr",
                            {{"auto", ProgressStyle::automatic},
                             {"bar", ProgressStyle::bar},
                             {"lines", ProgressStyle::lines},
                             {"json", ProgressStyle::json},
                             {"none", ProgressStyle::none}},
                            [&options](ProgressStyle style) { options.progress = style; })
      ->group(group);
  add_flag(app, "--dry-run", options.dry_run, "check the scene and print the files that would be written")
      ->group(group);
  add_flag(app, "--list-frames", options.list_frames,
           "the same, with the frame number and a tab before each file")
      ->group(group);
}

Parser render_parser() {
  struct State {
    SceneFlags scene;
    RenderOptions options;
    bool half = false;
    bool single = false;
  };
  const auto state = std::make_shared<State>();
  Parser parser{
      make_app("render", "Trace the images of a scene into OpenEXR files.", "[render] SCENE.toml [options]"),
      {}};
  CLI::App& app = *parser.app;
  add_output_flags(app, state->options);
  add_flag(app, "--half", state->half, "16-bit colour, the default; 32-bit if a value is too large for it")
      ->group("Output");
  add_flag(app, "--float", state->single, "32-bit colour")->group("Output");
  add_film_flags(app, state->scene.options.request, state->options);
  add_animation_flags(app, state->options);
  add_again_flags(app, state->options);
  add_scene_flags(app, state->scene);
  add_run_flags(app, state->options);
  add_verbosity(app, state->scene.quiet, &state->scene.verbose);
  parser.finish = [state]() -> Command {
    RenderOptions options = state->options;
    if (state->half && state->single) throw CLI::ValidationError("--half", "not together with --float");
    if (options.frames && options.time) throw CLI::ValidationError("--time", "not together with --frames");
    check_display(options.display);
    if (state->single) options.storage = ColourStorage::always_float;
    options.skip_existing |= options.resume || options.claim;
    options.scene = state->scene.scene();
    options.verbosity = state->scene.verbosity();
    return options;
  };
  return parser;
}

Parser check_parser() {
  const auto flags = std::make_shared<SceneFlags>();
  Parser parser{make_app("check", "Look for mistakes in a scene and explain what it needs; render nothing.",
                         "check SCENE.toml [options]"),
                {}};
  add_scene_flags(*parser.app, *flags);
  add_verbosity(*parser.app, flags->quiet, nullptr);
  parser.finish = [flags]() -> Command { return CheckOptions{flags->scene(), flags->verbosity()}; };
  return parser;
}

Parser schema_parser() {
  const auto options = std::make_shared<SchemaOptions>();
  Parser parser{
      make_app("schema", "Print the JSON Schema of the scene format, for editors.", "schema > scene.json"),
      {}};
  add_flag(*parser.app, "--markdown", options->markdown, "print the reference page of the format instead");
  parser.finish = [options]() -> Command { return *options; };
  return parser;
}

std::vector<std::filesystem::path> image_files(const std::vector<std::string>& files) {
  if (files.empty()) throw CLI::ValidationError("", "no image file is given");
  return {files.begin(), files.end()};
}

void add_threshold(CLI::App& app, const char* name, const char* value, const char* help, double& threshold,
                   const char* group) {
  add_value(app, name, value, help, parse_threshold, [&threshold](double given) {
    threshold = given;
  })->group(group);
}

void add_thresholds(CLI::App& app, CompareLimits& limits) {
  const char* fail = "Different (the rules are idiff's)";
  add_threshold(app, "--fail", "VAL", "a value may differ by so much; default 1e-6", limits.fail, fail);
  add_threshold(app, "--failrelative", "VAL", "or by this share of the two values' mean; default 0",
                limits.fail_relative, fail);
  add_threshold(app, "--failpercent", "PERCENT", "so many of the pixels may differ by more; default 0",
                limits.fail_percent, fail);
  add_value(app, "--allowfailures", "N", "or this number of them, by any amount; default 0",
            whole(0, std::int64_t{1} << 52),
            [&limits](std::int64_t count) { limits.allow_failures = static_cast<std::uint64_t>(count); })
      ->group(fail);
  add_threshold(app, "--hardfail", "VAL", "but no value by more than this; default inf", limits.hard_fail,
                fail);
  add_value(app, "--tolerance", "CHANNEL=VAL",
            "a --fail of its own for a channel or a layer, as in --tolerance Z=1e-3; may be repeated",
            parse_tolerance,
            [&limits](std::pair<std::string, double> one) { limits.tolerances.push_back(std::move(one)); })
      ->group(fail)
      ->take_all()
      ->trigger_on_parse();
  add_value(app, "--channels", "LIST", "compare only these channels or layers, with commas between",
            parse_list,
            [&limits](std::vector<std::string> channels) { limits.channels = std::move(channels); })
      ->group(fail);
  const char* warn = "Worth a warning; the exit status stays 0";
  add_threshold(app, "--warn", "VAL", "as --fail", limits.warn, warn);
  add_threshold(app, "--warnrelative", "VAL", "as --failrelative", limits.warn_relative, warn);
  add_threshold(app, "--warnpercent", "PERCENT", "as --failpercent", limits.warn_percent, warn);
  add_threshold(app, "--hardwarn", "VAL", "as --hardfail", limits.hard_warn, warn);
}

Parser compare_parser() {
  struct State {
    CompareOptions options;
    std::vector<std::string> paths;
    bool quiet = false;
    bool verbose = false;
  };
  const auto state = std::make_shared<State>();
  Parser parser{
      make_app("compare",
               "Tell whether images are equal to their references, channel by channel. Two folders "
               "are compared image by image.\nExit status: 0 equal, 1 different, 2 something "
               "could not be compared.",
               "compare REF.exr NEW.exr [options]\n       backlight compare REFDIR NEWDIR [options]"),
      {}};
  CLI::App& app = *parser.app;
  app.add_option("IMAGE.exr", state->paths);
  add_value(
      app, "--html", "FILE.html",
      "write a report: one page that needs nothing else, with both pictures, where they differ, and how "
      "to render the worst pixel again",
      parse_text, [state](std::string file) { state->options.html = file; })
      ->group("What to do");
  add_value(app, "--junit", "FILE.xml", "write the verdicts as JUnit XML, for servers that run tests",
            parse_text, [state](std::string file) { state->options.junit = file; })
      ->group("What to do");
  add_value(app, "--scenes", "FOLDER",
            "where the scenes of the images are, for the command lines that render a pixel again", parse_text,
            [state](std::string folder) { state->options.scenes = folder; })
      ->group("What to do");
  add_flag(app, "--update", state->options.update,
           "put new images in the places of the references that they differ from, and print which")
      ->group("What to do");
  add_thresholds(app, state->options.limits);
  add_verbosity(app, state->quiet, &state->verbose);
  parser.finish = [state]() -> Command {
    CompareOptions options = state->options;
    if (state->paths.size() < 2) {
      throw CLI::ValidationError("", "two images or two folders are needed: the reference and the new one");
    }
    if (state->paths.size() > 2)
      throw CLI::ValidationError("", "only two paths are compared; a third is '" + state->paths[2] + "'");
    if (state->quiet && state->verbose) throw CLI::ValidationError("--quiet", "not together with --verbose");
    options.reference = state->paths[0];
    options.now = state->paths[1];
    if (state->quiet) options.verbosity = Verbosity::quiet;
    if (state->verbose) options.verbosity = Verbosity::verbose;
    return options;
  };
  return parser;
}

void add_eye(CLI::App& app, std::size_t& view, const char* group) {
  add_choice<std::size_t>(app, "--eye", "EYE", "left (the default) or right, of a stereo pair",
                          {{"left", 0}, {"right", 1}}, [&view](std::size_t eye) { view = eye; })
      ->group(group);
}

void add_view_flags(CLI::App& app, ViewOptions& options) {
  const char* group = "Display";
  add_display_flags(app, options.display, group, nullptr);
  using Views = std::vector<std::size_t>;
  add_value(
      app, "--eye", "EYE",
      "left (the default) or right, of a stereo pair; or top-bottom, both in one picture, the left one above",
      choice<Views>({{"left", {0}}, {"right", {1}}, {"top-bottom", {0, 1}}}),
      [&options](Views views) { options.views = std::move(views); })
      ->group(group);
  add_flag(app, "--faces", options.faces,
           "write the six faces of a cubemap, each in a PNG of its own: NAME.right.png, left, up, down, "
           "front, back")
      ->group("Output");
  add_flag(
      app, "--why", options.why,
      "paint black pixels in the colour of why they are: missed blue, shadowed orange, shifted out of the "
      "visible pink, too faint green; and count them. For images rendered with --aov light")
      ->group(group);
}

void add_channel_flags(CLI::App& app, ViewOptions& options) {
  const char* group = "Data channels and words";
  add_value(
      app, "--channel", "NAME",
      "show a data channel instead of the colour, as doppler, Z, properTime or P.X, with a scale of its "
      "colours below. All images get the same scale",
      parse_text, [&options](std::string name) { options.channel = std::move(name); })
      ->group(group);
  add_value(app, "--range", "LO,HI", "values at the ends of that scale; default: the least and the greatest",
            parse_range, [&options](std::pair<double, double> range) { options.range = range; })
      ->group(group);
  add_value(app, "--label", "TEXT",
            "write this into each picture; {time}, {frame}, {params.NAME}, {file} stand for what the image "
            "tells, {time:.2} with two decimals",
            parse_text, [&options](std::string text) { options.label = std::move(text); })
      ->group(group);
}

void check_channel_flags(const ViewOptions& options) {
  if (options.range && options.channel.empty())
    throw CLI::ValidationError("--range", "is of the scale of --channel");
  if (options.channel.empty()) return;
  if (options.why) throw CLI::ValidationError("--channel", "not together with --why");
  const DisplayChoice& display = options.display;
  if (display.automatic_exposure || display.exposure_stops || display.tone || display.white)
    throw CLI::ValidationError("--channel", "--exposure, --tone and --white are for the colour");
}

Parser view_parser() {
  struct State {
    ViewOptions options;
    std::vector<std::string> files;
    bool quiet = false;
  };
  const auto state = std::make_shared<State>();
  Parser parser{make_app("view",
                         "Make a PNG to look at: exposure, tone curve, sRGB. Several images make a contact "
                         "sheet, all shown in the same way.",
                         "view IMAGE.exr... [options]"),
                {}};
  CLI::App& app = *parser.app;
  ViewOptions& options = state->options;
  app.add_option("IMAGE.exr", state->files);
  add_value(app, "-o,--output", "FILE.png",
            "file to write; default: the image's name with .png. A contact sheet needs a name. A folder, a "
            "name that ends in /, gets a PNG for each image",
            parse_text, [&options](std::string file) { options.output = file; })
      ->group("Output");
  add_flag(app, "--sheet", options.sheet, "make a contact sheet; so do several images without it")
      ->group("Output");
  add_value(app, "--columns", "N", "images in a row of a contact sheet", whole(1, 1000),
            [&options](std::int64_t columns) { options.columns = static_cast<int>(columns); })
      ->group("Output");
  add_view_flags(app, options);
  add_channel_flags(app, options);
  add_verbosity(app, state->quiet, nullptr);
  parser.finish = [state]() -> Command {
    ViewOptions finished = state->options;
    check_display(finished.display);
    check_channel_flags(finished);
    finished.files = image_files(state->files);
    if ((finished.sheet || (finished.files.size() > 1 && !finished.faces)) && finished.output.empty()) {
      throw CLI::ValidationError("", "several images make one contact sheet: name it with -o");
    }
    const bool folder = finished.output.filename().empty() || std::filesystem::is_directory(finished.output);
    if (finished.faces && !(folder || finished.output.empty()))
      throw CLI::ValidationError("--faces", "six files are written: -o names a folder for them");
    if (finished.faces && finished.sheet) throw CLI::ValidationError("--faces", "not together with --sheet");
    if (finished.sheet && folder)
      throw CLI::ValidationError("--sheet", "a contact sheet is one file, not a folder");
    if (state->quiet) finished.verbosity = Verbosity::quiet;
    return finished;
  };
  return parser;
}

Parser info_parser() {
  struct State {
    InfoOptions options;
    std::vector<std::string> files;
  };
  const auto state = std::make_shared<State>();
  Parser parser{make_app("info", "Tell what made an image: size, channels, scene, settings.",
                         "info IMAGE.exr... [options]"),
                {}};
  parser.app->add_option("IMAGE.exr", state->files);
  add_flag(*parser.app, "--json", state->options.json,
           "a JSON object for each image, or each part of one, a line each")
      ->group("Output");
  parser.finish = [state]() -> Command {
    return InfoOptions{image_files(state->files), state->options.json};
  };
  return parser;
}

Parser probe_parser() {
  struct State {
    ProbeOptions options;
    std::vector<std::string> words;  // the file, then pixels
  };
  const auto state = std::make_shared<State>();
  Parser parser{make_app("probe",
                         "Tell what an image has at some pixels: object, Doppler factor, angles, times, "
                         "distance. Pixels are counted from the top left, as --crop does.",
                         "probe IMAGE.exr X,Y [X,Y ...] [options]"),
                {}};
  CLI::App& app = *parser.app;
  app.add_option("IMAGE.exr", state->words);
  add_eye(app, state->options.view, "Output");
  add_flag(app, "--json", state->options.json, "a JSON object for each pixel, a line each")->group("Output");
  parser.finish = [state]() -> Command {
    ProbeOptions finished = state->options;
    finished.file = image_files(state->words).front();
    if (state->words.size() < 2) throw CLI::ValidationError("", "no pixel is given, such as 320,180");
    for (std::size_t i = 1; i < state->words.size(); ++i) {
      const auto pixel = parse_pixel(state->words[i]);
      if (!pixel.ok()) throw CLI::ValidationError("", pixel.error());
      finished.pixels.push_back({pixel.value().first, pixel.value().second});
    }
    return finished;
  };
  return parser;
}

Parser assemble_parser() {
  struct State {
    AssembleOptions options;
    std::vector<std::string> files;
  };
  const auto state = std::make_shared<State>();
  Parser parser{
      make_app("assemble",
               "Put an image together that was rendered in parts with --crop; the bytes are those of "
               "the image rendered as a whole.",
               "assemble PART.exr... -o IMAGE.exr [options]"),
      {}};
  CLI::App& app = *parser.app;
  AssembleOptions& options = state->options;
  app.add_option("PART.exr", state->files);
  add_value(app, "-o,--output", "IMAGE.exr", "file to write", parse_text,
            [&options](std::string file) { options.output = file; });
  add_flag(app, "--half", options.narrow,
           "make 16-bit colour of parts rendered with --float, unless a value is too large for it");
  parser.finish = [state]() -> Command {
    AssembleOptions finished = state->options;
    finished.parts = image_files(state->files);
    if (finished.output.empty()) throw CLI::ValidationError("", "name the image to write with -o");
    return finished;
  };
  return parser;
}

CommandManual manual_of(const std::string& name);

Parser manual_parser() {
  struct State {
    std::vector<std::string> commands;
    bool bash = false;
    bool zsh = false;
  };
  const auto state = std::make_shared<State>();
  Parser parser{
      make_app("manual",
               "Print a manual page, of the program or of a command, as `man -l -` reads it; or completion "
               "for a shell.",
               "manual [COMMAND] | man -l -\n       backlight manual --bash > FILE"),
      {}};
  parser.app->add_option("COMMAND", state->commands);
  add_flag(*parser.app, "--bash", state->bash, "print completion for bash instead")->group("Output");
  add_flag(*parser.app, "--zsh", state->zsh, "print completion for zsh instead")->group("Output");
  parser.finish = [state]() -> Command {
    if (int(state->bash) + int(state->zsh) + int(state->commands.size()) > 1)
      throw CLI::ValidationError("", "one page or one shell at a time");
    const auto date = source_date_epoch();
    if (!date.ok()) throw CLI::ValidationError("", date.error());
    if (!state->commands.empty()) {
      const std::string& command = state->commands.front();
      const std::vector<std::string> names{command_names.begin(), command_names.end()};
      if (std::ranges::find(names, command) == names.end())
        throw CLI::ValidationError("", not_one_of(names, command).message);
      return Answer{manual_page(manual_of(command), date.value()), false};
    }
    std::vector<CommandManual> all;
    for (const char* name : command_names) all.push_back(manual_of(name));
    if (state->bash) return Answer{bash_completion(all), false};
    if (state->zsh) return Answer{zsh_completion(all), false};
    return Answer{manual_page(all, date.value()), false};
  };
  return parser;
}

Parser parser_of(const std::string& name) {
  if (name == "check") return check_parser();
  if (name == "compare") return compare_parser();
  if (name == "view") return view_parser();
  if (name == "info") return info_parser();
  if (name == "probe") return probe_parser();
  if (name == "assemble") return assemble_parser();
  if (name == "schema") return schema_parser();
  if (name == "manual") return manual_parser();
  return render_parser();
}

Parser make_parser(const std::string& name) {
  Parser parser = parser_of(name);
  parser.app->set_help_flag("-h,--help", "print this help")->group("Other");
  return parser;
}

OptionManual manual_of(CLI::Option& option) {
  OptionManual manual;
  for (const std::string& name : option.get_snames()) manual.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) manual.names.push_back("--" + name);
  manual.value = option.get_type_name();
  manual.words = words_of(option);
  manual.meaning = option.get_description();
  manual.group = option.get_group();
  return manual;
}

// The groups in the order of --help.
CommandManual manual_of(const std::string& name) {
  const Parser parser = make_parser(name);
  CLI::App& app = *parser.app;
  CommandManual manual{name, app.get_description(), {}, {}, {}};
  manual.usage = dynamic_cast<const HelpFormatter&>(*app.get_formatter()).usage().substr(10);
  for (const std::string& group : app.get_groups()) {
    for (CLI::Option* option :
         app.get_options([&group](const CLI::Option* one) { return one->get_group() == group; })) {
      if (option->get_positional()) {
        manual.operands = option->get_name();
      } else {
        manual.options.push_back(manual_of(*option));
      }
    }
  }
  return manual;
}

bool is_flag(const std::string& argument) {
  return argument.size() > 1 && argument.front() == '-';
}

// Whether the argument after `flag` is its value, in whichever command has such a flag.
bool takes_next(const std::string& flag, const std::vector<Parser>& parsers) {
  const bool is_long = flag.starts_with("--");
  if (is_long ? flag.find('=') != std::string::npos : flag.size() > 2) return false;
  return std::any_of(parsers.begin(), parsers.end(), [&flag](const Parser& parser) {
    const CLI::Option* option = parser.app->get_option_no_throw(flag);
    return option != nullptr && option->get_items_expected_max() > 0;
  });
}

// The index of the first argument that is neither a flag nor the value of one.
std::size_t first_word(const std::vector<std::string>& arguments) {
  std::vector<Parser> parsers;
  for (const char* name : command_names) parsers.push_back(make_parser(name));
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--") return i + 1;
    if (!is_flag(arguments[i])) return i;
    if (takes_next(arguments[i], parsers)) ++i;
  }
  return arguments.size();
}

Answer usage_error(const std::string& command, const std::string& message) {
  const std::string help = command.empty() ? "backlight --help" : "backlight " + command + " --help";
  return {"backlight: " + message + "\nTry '" + help + "'.", true};
}

Answer unknown_argument(const std::string& command, const CLI::App& app,
                        const std::vector<std::string>& extras) {
  const auto flag = std::find_if(extras.begin(), extras.end(), is_flag);
  if (flag == extras.end()) return usage_error(command, "unexpected argument '" + extras.front() + "'");
  const std::string name = flag->substr(0, flag->find('='));
  for (const char* other : command_names) {
    const Parser parser = make_parser(other);
    if (parser.app->get_option_no_throw(name) == nullptr) continue;
    return usage_error(command, "'" + name + "' is an option of 'backlight " + other + "'");
  }
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& one : option->get_lnames()) known.push_back("--" + one);
  }
  const std::string nearest = name.starts_with("--") ? nearest_name(name, known) : "";
  return usage_error(command, "unknown option '" + name + "'" +
                                  (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
}

// Of the first `count` arguments, an option that no command has: what follows it may be meant as its value.
std::optional<std::string> unknown_option(const std::vector<std::string>& arguments, std::size_t count) {
  std::vector<Parser> parsers;
  for (const char* name : command_names) parsers.push_back(make_parser(name));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& argument = arguments[i];
    // Of short options, the letter: its value may be joined to it.
    const std::string name =
        argument.starts_with("--") ? argument.substr(0, argument.find('=')) : argument.substr(0, 2);
    const bool known = std::any_of(parsers.begin(), parsers.end(), [&name](const Parser& parser) {
      return parser.app->get_option_no_throw(name) != nullptr;
    });
    if (!known && is_flag(argument)) return argument;
    if (takes_next(argument, parsers)) ++i;
  }
  return std::nullopt;
}

// The first of the arguments that names a command; without one, to render is meant.
std::string meant_command(const std::vector<std::string>& arguments) {
  const auto named = std::find_first_of(arguments.begin(), arguments.end(), command_names.begin(),
                                        command_names.end(), std::equal_to<std::string>());
  return named != arguments.end() ? *named : "render";
}

// CLI11 leaves two blank lines between groups, and one at the end.
std::string one_blank_line(std::string text) {
  for (std::size_t i = text.find("\n\n\n"); i != std::string::npos; i = text.find("\n\n\n", i))
    text.erase(i, 1);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

Command parse_command(const std::string& name, std::vector<std::string> arguments) {
  Parser parser = make_parser(name);
  const std::vector<std::string> given = arguments;
  try {
    std::reverse(arguments.begin(), arguments.end());  // CLI11 takes them from the end
    parser.app->parse(std::move(arguments));
    std::vector<std::string> extras = parser.app->remaining();
    std::erase(extras, "--");
    if (!extras.empty()) return unknown_argument(name, *parser.app, extras);
    Command command = parser.finish();
    if (auto* options = std::get_if<RenderOptions>(&command)) options->arguments = given;
    return command;
  } catch (const CLI::CallForHelp&) {
    return Answer{one_blank_line(parser.app->help()), false};
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string message = error.what();  // "--samples: 1 required N missing"
    return usage_error(name, message.substr(0, message.find(':')) + " needs a value");
  } catch (const CLI::ParseError& error) {
    std::string message = error.what();
    if (message.starts_with(": ")) message.erase(0, 2);
    return usage_error(name, message);
  }
}

}  // namespace

Command parse_command_line(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return usage_error("", "no scene file is given");
  const std::size_t place = first_word(arguments);
  if (place >= arguments.size()) {
    const auto asks = [&arguments](const char* flag) {
      return std::find(arguments.begin(), arguments.end(), flag) != arguments.end();
    };
    if (asks("--help") || asks("-h")) return Answer{general_help(), false};
    if (asks("--version")) return Answer{"Backlight " BACKLIGHT_VERSION "\n", false};
    return parse_command("render", arguments);
  }
  const std::string& word = arguments[place];
  std::vector<std::string> rest = arguments;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(place));
  if (word == "help")
    return rest.empty() ? Command{Answer{general_help(), false}} : parse_command(rest[0], {"--help"});
  if (std::find(command_names.begin(), command_names.end(), word) != command_names.end()) {
    return parse_command(word, std::move(rest));
  }
  const bool looks_like_a_file =
      word == "-" || word.find_first_of("./") != std::string::npos || std::filesystem::exists(word);
  if (!looks_like_a_file) {
    if (const auto option = unknown_option(arguments, place)) {
      const std::string command = meant_command(arguments);
      return unknown_argument(command, *make_parser(command).app, {*option});
    }
    const std::string nearest = nearest_name(word, {command_names.begin(), command_names.end()});
    return usage_error("", "there is neither a command nor a file called '" + word + "'" +
                               (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
  }
  return parse_command("render", arguments);
}

}  // namespace backlight
