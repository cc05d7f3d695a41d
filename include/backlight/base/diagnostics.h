// What is told to the author of a text: errors and warnings with a place in their source.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace backlight {

/// A text that diagnostics point into: a scene file, or a -D override of the command line.
struct SourceText {
  std::string name;  ///< as shown to the user: the path as given, or "command line"
  std::string text;  ///< the whole text
};

/// A place in a source text. Lines and columns count from 1, columns in characters (UTF-8 code points).
/// A default span has no source: the diagnostic is then about the run as a whole.
struct SourceSpan {
  std::shared_ptr<const SourceText> source;
  int line = 0;
  int column = 0;
  int length = 1;  ///< how many characters of the line the caret underlines
};

enum class Severity { warning, error };

/// One thing to say: `message` states what is wrong and what was expected; `hint`, if any, what to write
/// instead ("did you mean 'sphere'?").
struct Diagnostic {
  Severity severity = Severity::error;
  SourceSpan span;
  std::string message;
  std::string hint;
};

/// Collects what is found wrong in a text, so that all of it is reported together.
class Diagnostics {
 public:
  void error(SourceSpan span, std::string message, std::string hint = {});
  void warning(SourceSpan span, std::string message, std::string hint = {});

  [[nodiscard]] bool has_errors() const { return error_count_ > 0; }
  [[nodiscard]] std::size_t error_count() const { return error_count_; }
  [[nodiscard]] const std::vector<Diagnostic>& all() const { return all_; }

 private:
  std::vector<Diagnostic> all_;
  std::size_t error_count_ = 0;
};

/// The diagnostic as it is printed: "file:line:column: error: message", the source line, a caret line and
/// the hint. No trailing newline.
std::string format(const Diagnostic& diagnostic);

/// The candidate nearest to `word` by edit distance (case ignored) and, of equally near ones, that which
/// begins most alike; empty when none is near enough to be a plausible slip.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace backlight
