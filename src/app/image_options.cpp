// The options of the commands that read images: view, info, probe, assemble.
#include <memory>

#include "command_table.h"

namespace backlight {
namespace {

void add_output_rows(CommandTable& table, ViewOptions& options) {
  RowGroup group(table, "Output");
  group.value("-o,--output", "FILE.png",
              "file to write; default: the image's name with .png. A contact sheet needs a name. A folder, a "
              "name that ends in /, gets a PNG for each image",
              parse_text, options.output);
  group.flag("--sheet", options.sheet, "make a contact sheet; so do several images without it");
  group.value("--columns", "N", "images in a row of a contact sheet", whole<int>(1, 1000), options.columns);
  group.flag("--faces", options.faces,
             "write the six faces of a cubemap, each in a PNG of its own: NAME.right.png, left, up, down, "
             "front, back");
}

using Views = std::vector<std::size_t>;

void add_view_rows(CommandTable& table, ViewOptions& options) {
  RowGroup display(table, "Display");
  add_display_rows(display, options.display, "");
  display.choice<Views>(
      "--eye", "EYE",
      "left (the default) or right, of a stereo pair; or top-bottom, both in one picture, the left one above",
      {{"left", {0}}, {"right", {1}}, {"top-bottom", {0, 1}}}, options.views);
  display.flag(
      "--why", options.why,
      "paint black pixels in the colour of why they are: missed blue, shadowed orange, shifted out of the "
      "visible pink, too faint green; and count them. For images rendered with --aov light");
  RowGroup data(table, "Data channels and words");
  data.value(
          "--channel", "NAME",
          "show a data channel instead of the colour, as doppler, Z, properTime or P.X, with a scale of its "
          "colours below. All images get the same scale",
          parse_text, options.channel)
      .words = {"Z",       "doppler",  "emissionTime", "properTime", "P.X",        "P.Y",     "P.Z",
                "N.X",     "N.Y",      "N.Z",          "objectId",   "unresolved", "light.N", "light.Y",
                "samples", "mirror.Z", "mirror.D",     "mirror.T",   "mirror.V",   "lampTime"};
  data.value("--range", "LO,HI", "values at the ends of that scale; default: the least and the greatest",
             parse_range, options.range);
  add_label_row(data, options.label, "");
}

Result<void> check_channel(const ViewOptions& options) {
  if (options.range && options.channel.empty()) return Failure{"--range: is of the scale of --channel"};
  if (options.channel.empty()) return {};
  if (options.why) return Failure{"--channel: not together with --why"};
  const DisplayChoice& display = options.display;
  if (display.automatic_exposure || display.exposure_stops || display.tone || display.white)
    return Failure{"--channel: --exposure, --tone and --white are for the colour"};
  return {};
}

bool is_folder(const std::filesystem::path& output) {
  return output.filename().empty() || std::filesystem::is_directory(output);
}

Result<void> check_faces_output(const std::filesystem::path& output) {
  if (output.empty() || is_folder(output)) return {};
  return Failure{"--faces: six files are written: -o names a folder for them"};
}

Result<void> check_output(const ViewOptions& options) {
  if ((options.sheet || (options.files.size() > 1 && !options.faces)) && options.output.empty())
    return Failure{"several images make one contact sheet: name it with -o"};
  if (options.faces && options.sheet) return Failure{"--faces: not together with --sheet"};
  if (options.faces) return check_faces_output(options.output);
  if (options.sheet && is_folder(options.output))
    return Failure{"--sheet: a contact sheet is one file, not a folder"};
  return {};
}

void add_json(CommandTable& table, bool& json, std::string meaning) {
  RowGroup(table, "Output").flag("--json", json, std::move(meaning));
}

}  // namespace

CommandTable view_table() {
  struct State {
    ViewOptions options;
    bool quiet = false;
  };
  const auto state = std::make_shared<State>();
  CommandTable table{{"view",
                      "Make a PNG to look at: exposure, tone curve, sRGB. Several images make a contact "
                      "sheet, all shown in the same way.",
                      "view IMAGE.exr... [options]", "IMAGE.exr"}};
  add_output_rows(table, state->options);
  add_view_rows(table, state->options);
  add_quiet(table, state->quiet);
  table.finish = [state](const std::vector<std::string>& operands) -> Result<Command> {
    ViewOptions options = state->options;
    const auto files = image_files(operands);
    if (!files.ok()) return files.failure();
    options.files = files.value();
    for (const auto& checked :
         {check_display(options.display), check_channel(options), check_output(options)}) {
      if (!checked.ok()) return checked.failure();
    }
    if (state->quiet) options.verbosity = Verbosity::quiet;
    return Command{std::move(options)};
  };
  return table;
}

CommandTable info_table() {
  const auto state = std::make_shared<InfoOptions>();
  CommandTable table{{"info", "Tell what made an image: size, channels, scene, settings.",
                      "info IMAGE.exr... [options]", "IMAGE.exr"}};
  add_json(table, state->json, "a JSON object for each image, or each part of one, a line each");
  table.finish = [state](const std::vector<std::string>& operands) -> Result<Command> {
    const auto files = image_files(operands);
    if (!files.ok()) return files.failure();
    return Command{InfoOptions{files.value(), state->json}};
  };
  return table;
}

CommandTable probe_table() {
  const auto state = std::make_shared<ProbeOptions>();
  CommandTable table{{"probe",
                      "Tell what an image has at some pixels: object, Doppler factor, angles, times, "
                      "distance. Pixels are counted from the top left, as --crop does.",
                      "probe IMAGE.exr X,Y [X,Y ...] [options]", "IMAGE.exr"}};
  RowGroup(table, "Output")
      .choice<std::size_t>("--eye", "EYE", "left (the default) or right, of a stereo pair",
                           {{"left", 0}, {"right", 1}}, state->view);
  add_json(table, state->json, "a JSON object for each pixel, a line each");
  table.finish = [state](const std::vector<std::string>& words) -> Result<Command> {
    ProbeOptions options = *state;
    const auto files = image_files(words);
    if (!files.ok()) return files.failure();
    options.file = files.value().front();
    if (words.size() < 2) return Failure{"no pixel is given, such as 320,180"};
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto pixel = parse_pixel(words[i]);
      if (!pixel.ok()) return pixel.failure();
      options.pixels.push_back({pixel.value().first, pixel.value().second});
    }
    return Command{std::move(options)};
  };
  return table;
}

CommandTable assemble_table() {
  const auto state = std::make_shared<AssembleOptions>();
  CommandTable table{{"assemble",
                      "Put an image together that was rendered in parts with --crop; the bytes are those of "
                      "the image rendered as a whole. Or cut a cubemap into its faces.",
                      "assemble PART.exr... -o IMAGE.exr [options]\n       backlight assemble CUBEMAP.exr "
                      "--faces [-o FOLDER/]",
                      "PART.exr"}};
  RowGroup group(table, "Options");
  group.value("-o,--output", "IMAGE.exr", "file to write; with --faces a folder, or else beside the cubemap",
              parse_text, state->output);
  group.flag("--half", state->narrow,
             "make 16-bit colour of parts rendered with --float, unless a value is too large for it");
  group.flag("--faces", state->faces,
             "write the six faces of a cubemap, each with all its channels: NAME.right.exr, left, up, down, "
             "front, back");
  table.finish = [state](const std::vector<std::string>& operands) -> Result<Command> {
    AssembleOptions options = *state;
    const auto files = image_files(operands);
    if (!files.ok()) return files.failure();
    options.parts = files.value();
    if (options.faces && options.narrow) return Failure{"--faces: not together with --half"};
    if (options.faces && options.parts.size() > 1) return Failure{"--faces: one cubemap at a time"};
    if (options.faces) {
      if (auto folder = check_faces_output(options.output); !folder.ok()) return folder.failure();
    } else if (options.output.empty()) {
      return Failure{"name the image to write with -o"};
    }
    return Command{std::move(options)};
  };
  return table;
}

}  // namespace backlight
