// backlight: the command line. Each command is a file of its own.
#include <unistd.h>

#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <variant>
#include <vector>

#include "backlight/film/exr.h"
#include "commands.h"
#include "exit_codes.h"
#include "options.h"
#include "signals.h"
#include "standard_streams.h"

namespace backlight {
namespace {

int run(const Answer& answer) {
  (answer.usage_error ? std::cerr : std::cout) << answer.text << (answer.usage_error ? "\n" : "");
  return answer.usage_error ? exit_usage : exit_success;
}

// What went to stdout may still be in a buffer, and its file on a full disk. Who reads only the begin of what
// is printed (`| head`) knows that there is more.
int flushed(int code) {
  std::cout.flush();
  if (std::cout.good()) return code;
  if (has_no_reader(STDOUT_FILENO)) end_by_broken_pipe();
  std::cerr << "backlight: error: cannot write to standard output\n";
  return code == exit_success ? exit_file_trouble : code;
}

int run_program(const std::vector<std::string>& arguments) {
  begin_exr();
  const Command command = parse_command_line(arguments);
  if (std::holds_alternative<RenderOptions>(command)) catch_stop_signals();
  release_held_signals();
  return flushed(std::visit([](const auto& options) { return run(options); }, command));
}

}  // namespace
}  // namespace backlight

int main(int count, char** arguments) {
  backlight::keep_standard_streams_apart();
  backlight::make_signals_of_writing_errors();
  try {
    return backlight::run_program(std::vector<std::string>(arguments + 1, arguments + count));
  } catch (const std::bad_alloc&) {
    std::cerr << "backlight: error: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "backlight: error: " << error.what() << '\n';
  }
  return backlight::exit_frame_failed;
}
