// What was asked for on the command line, one structure a command.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "backlight/film/compare.h"
#include "backlight/film/exposure.h"
#include "backlight/film/exr.h"
#include "backlight/film/image.h"
#include "backlight/render/image_sequence.h"
#include "backlight/render/progress.h"
#include "backlight/scene/compile.h"
#include "pixel_probe.h"

namespace backlight {

/// A scene file, and what is changed in it.
struct SceneOptions {
  std::filesystem::path file;          ///< "-": standard input
  std::vector<std::string> overrides;  ///< "path=value", of -D
  ImageRequest request;                ///< camera and film; which frame is for the command to say
};

/// Whether a scene is to come from the standard input. A file of that name is "./-".
inline bool is_standard_input(const std::filesystem::path& scene) {
  return scene == "-";
}

/// How much is said on stderr, errors apart.
enum class Verbosity { quiet, normal, verbose };

struct RenderOptions {
  SceneOptions scene;
  std::optional<OutputPattern> output;     ///< none: the scene's name, in the current folder
  std::optional<std::vector<int>> frames;  ///< none: those of the scene
  std::optional<double> time;              ///< one image at this scene time instead, in seconds
  std::optional<PixelBox> crop;
  ColourStorage storage = ColourStorage::automatic;
  bool png = false;
  DisplayChoice display;  ///< of the PNGs
  std::string label;      ///< words to put into each PNG (label_text.h)
  int threads = 0;        ///< 0: usable_threads()
  ProgressStyle progress = ProgressStyle::automatic;
  Verbosity verbosity = Verbosity::normal;
  std::filesystem::path statistics;  ///< empty: none
  bool dry_run = false;
  bool list_frames = false;
  bool skip_existing = false;  ///< images whose file is complete and of the same identity; true with the next
  bool resume = false;         ///< go on with partial images
  bool claim = false;          ///< share the images with other processes through the folder
  std::chrono::milliseconds claim_expiry{60'000};
  std::vector<std::string> arguments;  ///< of the command line as given, for messages
};

struct CheckOptions {
  SceneOptions scene;
  Verbosity verbosity = Verbosity::normal;
};

struct SchemaOptions {
  bool markdown = false;  ///< the reference page instead
};

struct CompareOptions {
  std::filesystem::path reference;  ///< file or folder
  std::filesystem::path now;        ///< the same
  CompareLimits limits;
  std::filesystem::path html;    ///< report to write; empty: none
  std::filesystem::path junit;   ///< the verdicts as JUnit XML; empty: none
  std::filesystem::path scenes;  ///< folder of the scenes, whose files' names alone are in the images
  bool update = false;           ///< the new images take the places of references that they differ from
  Verbosity verbosity = Verbosity::normal;
};

struct ViewOptions {
  std::vector<std::filesystem::path> files;  ///< several make a contact sheet
  std::filesystem::path output;              ///< empty: the file's name with .png; a folder: one PNG each
  DisplayChoice display;
  std::vector<std::size_t> views{0};  ///< 0: left, or the only one; 1: right; both: one above the other
  bool faces = false;                 ///< of cubemaps, each face in a PNG of its own
  int columns = 0;                    ///< of a contact sheet; 0: as square as it can be
  bool sheet = false;                 ///< a contact sheet was asked for by name
  bool why = false;                   ///< black pixels in the colours of why they are
  std::string channel;                ///< a data channel instead of the colour; empty: none
  std::optional<std::pair<double, double>> range;  ///< of its values, instead of all that there are
  std::string label;                               ///< words to put into each picture (label_text.h)
  Verbosity verbosity = Verbosity::normal;
};

struct InfoOptions {
  std::vector<std::filesystem::path> files;
  bool json = false;
};

struct ProbeOptions {
  std::filesystem::path file;
  std::vector<PixelPlace> pixels;  ///< at least one
  std::size_t view = 0;            ///< 0: left, or the only one; 1: right
  bool json = false;
};

struct AssembleOptions {
  std::vector<std::filesystem::path> parts;
  std::filesystem::path output;
  bool faces = false;   ///< cut into the six of a cubemap; then `output` is a folder, or empty
  bool narrow = false;  ///< colour of 32 bits becomes one of 16 bits where a whole render would have it so
};

/// Help or the version was asked for, and is to go to stdout; or the command line is wrong.
struct Answer {
  std::string text;
  bool usage_error = false;
};

using Command = std::variant<Answer, RenderOptions, CheckOptions, SchemaOptions, CompareOptions, ViewOptions,
                             InfoOptions, ProbeOptions, AssembleOptions>;

/// Reads the arguments after the program's name.
Command parse_command_line(const std::vector<std::string>& arguments);

}  // namespace backlight
