// What the program returns to the shell.
#pragma once

namespace backlight {

/// Besides these: 128 + n when stopped by signal n.
enum ExitCode : int {
  exit_success = 0,       ///< everything was written
  exit_frame_failed = 1,  ///< an image could not be made; the others were
  exit_usage = 2,         ///< the command line is wrong
  exit_scene_wrong = 3,   ///< the scene file is wrong; nothing was rendered
  exit_file_trouble = 4,  ///< a file cannot be read or written
  exit_stopped = 128,

  // compare has its own, those of cmp and diff:
  exit_compare_differs = 1,  ///< an image differs, is missing, or has no reference
  exit_compare_trouble = 2   ///< something could not be compared
};

}  // namespace backlight
