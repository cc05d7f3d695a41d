// Which images of an animation to render, and what their files are called.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "backlight/base/result.h"

namespace backlight {

/// The numbers of a list of frames, in the order written, each once: "7", "1-100", "1-100x2" (1, 3, ..., 99),
/// "1-100x2,150". Numbers may be negative. Fails with what is wrong on anything else, on a range that runs
/// backwards, and on more than a million frames.
Result<std::vector<int>> parse_frames(std::string_view text);

/// A path with a place for the frame number in the file's name: "%04d" (printf's, with any width) or hashes,
/// one of which means four digits and n of which mean n. "%%" is a percent sign there. A larger number takes
/// more digits. The folder, all that is before the last slash, is taken as it is.
class OutputPattern {
 public:
  /// Fails on an empty name, and on a percent sign that is not followed as above.
  static Result<OutputPattern> parse(std::string_view text);

  /// A name that is taken as it is.
  static OutputPattern literal(std::string name);

  /// The file `name`, taken as it is, in the folder that this pattern names.
  [[nodiscard]] OutputPattern with_file(std::string_view name) const;

  /// Whether the name depends on the frame.
  [[nodiscard]] bool has_number() const { return has_number_; }

  /// The pattern for several images: itself, or with ".####" before the extension when it has no number.
  [[nodiscard]] OutputPattern numbered() const;

  [[nodiscard]] std::filesystem::path path(int frame) const;

 private:
  struct Piece {
    std::string text;  // literal, when width < 0
    int width = -1;    // digits of a number, filled up with zeros; 0: as many as needed
  };

  void append(std::string_view text);

  std::vector<Piece> pieces_;  // never two literals in a row
  bool has_number_ = false;
};

}  // namespace backlight
