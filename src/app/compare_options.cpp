// The options of compare.
#include <memory>

#include "command_table.h"

namespace backlight {
namespace {

void add_what_to_do(CommandTable& table, CompareOptions& options) {
  RowGroup group(table, "What to do");
  group.value("--html", "FILE.html",
              "write a report: one page that needs nothing else, with both pictures, where they differ, and "
              "how to render the worst pixel again",
              parse_text, options.html);
  group.value("--junit", "FILE.xml", "write the verdicts as JUnit XML, for servers that run tests",
              parse_text, options.junit);
  group.value("--scenes", "FOLDER",
              "where the scenes of the images are, for the command lines that render a pixel again",
              parse_text, options.scenes);
  group.flag("--update", options.update,
             "put new images in the places of the references that they differ from, and print which");
}

void add_thresholds(CommandTable& table, CompareLimits& limits) {
  RowGroup fail(table, "Different (the rules are idiff's)");
  fail.value("--fail", "VAL", "a value may differ by so much; default 1e-6", parse_threshold, limits.fail);
  fail.value("--failrelative", "VAL", "or by this share of the two values' mean; default 0", parse_threshold,
             limits.fail_relative);
  fail.value("--failpercent", "PERCENT", "so many of the pixels may differ by more; default 0",
             parse_threshold, limits.fail_percent);
  fail.value("--allowfailures", "N", "or this number of them, by any amount; default 0",
             whole<std::uint64_t>(0, std::int64_t{1} << 52), limits.allow_failures);
  fail.value("--hardfail", "VAL", "but no value by more than this; default inf", parse_threshold,
             limits.hard_fail);
  fail.value("--tolerance", "CHANNEL=VAL",
             "a --fail of its own for a channel or a layer, as in --tolerance Z=1e-3; may be repeated",
             parse_tolerance,
             [&limits](std::pair<std::string, double> one) { limits.tolerances.push_back(std::move(one)); })
      .every = true;
  fail.value("--channels", "LIST", "compare only these channels or layers, with commas between", parse_list,
             limits.channels);
  RowGroup warn(table, "Worth a warning; the exit status stays 0");
  warn.value("--warn", "VAL", "as --fail", parse_threshold, limits.warn);
  warn.value("--warnrelative", "VAL", "as --failrelative", parse_threshold, limits.warn_relative);
  warn.value("--warnpercent", "PERCENT", "as --failpercent", parse_threshold, limits.warn_percent);
  warn.value("--hardwarn", "VAL", "as --hardfail", parse_threshold, limits.hard_warn);
}

}  // namespace

CommandTable compare_table() {
  struct State {
    CompareOptions options;
    bool quiet = false;
    bool verbose = false;
  };
  const auto state = std::make_shared<State>();
  CommandTable table{{"compare",
                      "Tell whether images are equal to their references, channel by channel. Two folders "
                      "are compared image by image.\nExit status: 0 equal, 1 different, 2 something "
                      "could not be compared.",
                      "compare REF.exr NEW.exr [options]\n       backlight compare REFDIR NEWDIR [options]",
                      "IMAGE.exr"}};
  add_what_to_do(table, state->options);
  add_thresholds(table, state->options.limits);
  add_verbosity(table, state->quiet, state->verbose);
  table.finish = [state](const std::vector<std::string>& paths) -> Result<Command> {
    CompareOptions options = state->options;
    if (paths.size() < 2)
      return Failure{"two images or two folders are needed: the reference and the new one"};
    if (paths.size() > 2) return Failure{"only two paths are compared; a third is '" + paths[2] + "'"};
    const auto verbosity = verbosity_of(state->quiet, state->verbose);
    if (!verbosity.ok()) return verbosity.failure();
    options.reference = paths[0];
    options.now = paths[1];
    options.verbosity = verbosity.value();
    return Command{std::move(options)};
  };
  return table;
}

}  // namespace backlight
