#include "backlight/base/diagnostics.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace backlight {
namespace {

std::string source_line(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int i = 1; i < line && begin != std::string::npos; ++i) {
    begin = text.find('\n', begin);
    if (begin != std::string::npos) ++begin;
  }
  if (begin == std::string::npos) return {};
  std::string found = text.substr(begin, text.find('\n', begin) - begin);
  if (!found.empty() && found.back() == '\r') found.pop_back();
  return found;
}

bool continues_code_point(char c) {
  return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

// White space of the width of the first `columns` characters; tabs stay tabs so that the caret lines up.
std::string padding(const std::string& line, int columns) {
  std::string pad;
  for (const char c : line) {
    if (continues_code_point(c)) continue;
    if (columns-- <= 0) break;
    pad += c == '\t' ? '\t' : ' ';
  }
  if (columns > 0) pad.append(static_cast<std::size_t>(columns), ' ');
  return pad;
}

// Characters [first, first + count) of a line, which may have fewer.
std::string characters(const std::string& line, int first, int count) {
  std::string part;
  int place = -1;
  for (const char c : line) {
    if (!continues_code_point(c)) ++place;
    if (place >= first + count) break;
    if (place >= first) part += c;
  }
  return part;
}

// The source line with a mark under `length` characters from `column`. Of a line that is too long to be read,
// a piece.
std::string marked_line(const std::string& line, int column, int length) {
  constexpr int longest = 200;
  constexpr int before = 60;
  const int size = static_cast<int>(
      std::count_if(line.begin(), line.end(), [](char c) { return !continues_code_point(c); }));
  std::string shown = line;
  if (size > longest) {
    const int first = std::max(0, column - 1 - before);
    const std::string lead = first > 0 ? "..." : "";
    shown = lead + characters(line, first, longest) + (first + longest < size ? "..." : "");
    column += static_cast<int>(lead.size()) - first;
    length = std::min(length, longest - (column - 1));
  }
  std::string text = "\n  " + shown + "\n  " + padding(shown, column - 1) + "^";
  if (length > 1) text.append(static_cast<std::size_t>(length - 1), '~');
  return text;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      const std::size_t change = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + change});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

void Diagnostics::error(SourceSpan span, std::string message, std::string hint) {
  all_.push_back({Severity::error, std::move(span), std::move(message), std::move(hint)});
  ++error_count_;
}

void Diagnostics::warning(SourceSpan span, std::string message, std::string hint) {
  all_.push_back({Severity::warning, std::move(span), std::move(message), std::move(hint)});
}

std::string format(const Diagnostic& diagnostic) {
  const char* severity = diagnostic.severity == Severity::error ? "error" : "warning";
  const SourceSpan& span = diagnostic.span;
  std::string out;
  if (span.source) {
    out += span.source->name;
    if (span.line > 0) out += ":" + std::to_string(span.line) + ":" + std::to_string(span.column);
    out += ": ";
  }
  out += severity;
  out += ": " + diagnostic.message;
  if (span.source && span.line > 0) {
    out += marked_line(source_line(span.source->text, span.line), span.column, span.length);
  }
  if (!diagnostic.hint.empty()) out += "\n  " + diagnostic.hint;
  return out;
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  const std::size_t limit = std::max<std::size_t>(1, word.size() / 3 + 1);
  const auto begins_alike = [&](const std::string& candidate) {
    return std::ranges::mismatch(word, candidate).in1 - word.begin();
  };
  std::string best;
  std::size_t best_distance = limit + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    const bool as_near = !best.empty() && distance == best_distance;
    if (distance < best_distance || (as_near && begins_alike(candidate) > begins_alike(best))) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

}  // namespace backlight
