// libFuzzer entry: any bytes are a formula, a box and lines through it; every evaluator and every search is
// run on them. Bounds hold the values that doubles have, lanes of every width and number agree to the bit,
// and no change of sign is missed where the formula is continuous.
//
// Bytes that begin with '=' hold a formula as a text, up to the end of the line; others choose one.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "../../src/surface/implicit_roots.h"
#include "backlight/base/instruction_sets.h"
#include "backlight/expression/affine.h"
#include "backlight/expression/enclosure.h"
#include "backlight/surface/implicit_surface.h"

namespace {

using namespace backlight;

constexpr std::size_t variables = ImplicitFormula::variables;
using Place = std::array<double, variables>;

std::string formula_text;

void require(bool fact, const char* what) {
  if (fact) return;
  std::fprintf(stderr, "%s\nf = \"%s\"\n", what, formula_text.c_str());
  std::abort();
}

/// Choices from bytes, zeros when these have come to an end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  int below(int count) { return next() % count; }
  double part() { return (next() + 256.0 * next()) / 65536.0; }
  [[nodiscard]] bool at_end() const { return used_ >= size_; }

  /// As formulas and bounds have them, and as they had better not.
  double number() {
    static const std::array<double, 16> special{0.0,   -0.0, 1.0,    -1.0,   0.5,    2.0,   1e-300, -1e-300,
                                                1e300, 1e9,  -1e-17, 1e-320, 3.1416, -1e16, 1e4,    -0.25};
    if (below(3) == 0) return special[static_cast<std::size_t>(below(16))];
    return 8.0 * part() - 4.0;
  }

  /// Up to `end`, if that comes.
  std::string text(char end) {
    std::string result;
    while (!at_end() && data_[used_] != static_cast<std::uint8_t>(end)) result += static_cast<char>(next());
    next();
    return result;
  }

 private:
  std::uint8_t next() { return at_end() ? std::uint8_t{0} : data_[used_++]; }

  const std::uint8_t* data_;
  std::size_t size_;
  std::size_t used_ = 0;
};

std::string some_formula(Bytes& bytes, int depth) {
  static const std::array<const char*, 16> unary{"sin",  "cos",  "tan",  "asin", "acos",  "atan",
                                                 "sinh", "cosh", "exp",  "log",  "floor", "sqrt",
                                                 "cbrt", "abs",  "tanh", "-"};
  static const std::array<const char*, 6> binary{"min", "max", "mod", "pow", "atan2", "clamp"};
  static const std::array<const char*, 5> infix{"+", "-", "*", "/", "^"};
  const int kind = depth == 0 ? bytes.below(4) : bytes.below(10);
  if (kind < 3) return std::string(1, "xyz"[kind]);
  if (kind == 3) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "(%.17g)", bytes.number());
    return text.data();
  }
  const std::string a = some_formula(bytes, depth - 1);
  if (kind < 6) return std::string(unary[static_cast<std::size_t>(bytes.below(16))]) + "(" + a + ")";
  const std::string b = some_formula(bytes, depth - 1);
  if (kind < 9) return "(" + a + ")" + infix[static_cast<std::size_t>(bytes.below(5))] + "(" + b + ")";
  const std::string name = binary[static_cast<std::size_t>(bytes.below(6))];
  return name + "(" + a + ", " + b + (name == "clamp" ? ", 1)" : ")");
}

/// What doubles say at a place; NaN, too, where an infinity or NaN comes up on the way, of which intervals
/// know nothing.
double value_at(const Tape& tape, const Place& place) {
  std::vector<double> registers(tape.registers);
  for (const Instruction& step : tape.instructions) {
    double& out = registers[step.out];
    if (step.operation == Operation::constant) {
      out = tape.constants[step.a];
    } else if (step.operation == Operation::variable) {
      out = place[step.a];
    } else {
      out = apply<double>(step.operation, registers[step.a], registers[step.b]);
    }
    if (!std::isfinite(out)) return std::numeric_limits<double>::quiet_NaN();
  }
  return registers[0];
}

void check_holds(const Interval& range, double value) {
  if (!std::isfinite(value)) return;
  require(range.continuity != Continuity::undefined, "a value is said to be undefined");
  require(range.contains(value), "a value is outside its bounds");
}

void check_box(const Tape& tape, Bytes& bytes) {
  std::array<Interval, variables> box;
  for (Interval& side : box) {
    const double one = bytes.number();
    const double other = bytes.below(4) == 0 ? one : bytes.number();
    side = {std::min(one, other), std::max(one, other), Continuity::continuous};
  }
  const Interval range = enclose(tape, box);
  require(range.continuity == Continuity::undefined || range.lower <= range.upper, "an interval is empty");
  for (int i = 0; i < 12; ++i) {
    Place at{};
    for (std::size_t v = 0; v < variables; ++v) {
      const double part = i < 8 ? i >> v & 1 : bytes.part();
      at[v] =
          std::min(box[v].upper, std::max(box[v].lower, box[v].lower * (1.0 - part) + box[v].upper * part));
    }
    check_holds(range, value_at(tape, at));
  }
}

LinePiece some_line(Bytes& bytes) {
  LinePiece line;
  for (std::size_t v = 0; v < 3; ++v) {
    line.origin[v] = bytes.below(8) == 0 ? bytes.number() : 4.0 * bytes.part() - 2.0;
    line.direction[v] = bytes.below(5) == 0 ? 0.0 : 2.0 * bytes.part() - 1.0;
  }
  if (line.direction[0] == 0.0 && line.direction[1] == 0.0 && line.direction[2] == 0.0)
    line.direction[0] = 1.0;
  line.from = -2.0 + bytes.part();
  line.to = 2.0 - bytes.part();
  return line;
}

void put(LineBatch& batch, std::size_t slot, const LinePiece& line) {
  for (std::size_t v = 0; v < variables; ++v) {
    batch.origin(v)[slot] = line.origin[v];
    batch.direction(v)[slot] = line.direction[v];
  }
  batch.from()[slot] = line.from;
  batch.to()[slot] = line.to;
}

using Question = void (LineProgram::*)(LineBatch&, std::size_t, std::vector<double>&) const;

/// What is found of each line, five numbers a line.
std::vector<double> answers(const LineProgram& program, Question question,
                            const std::vector<LinePiece>& lines) {
  LineBatch batch(lines.size());
  std::vector<double> workspace;
  for (std::size_t i = 0; i < lines.size(); ++i) put(batch, i, lines[i]);
  (program.*question)(batch, lines.size(), workspace);
  std::vector<double> found;
  const bool bounds = question != &LineProgram::numbers;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    found.insert(found.end(), {batch.lower()[i], bounds ? batch.upper()[i] : 0.0, batch.slope_lower()[i],
                               question == &LineProgram::enclose_pieces ? batch.slope_upper()[i] : 0.0,
                               bounds ? batch.continuity()[i] : 0.0});
  }
  return found;
}

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

void require_same(const std::vector<double>& a, std::size_t from, const std::vector<double>& b) {
  for (std::size_t i = 0; i < b.size(); ++i) require(same(a[from + i], b[i]), "lanes do not agree");
}

/// Every line gets the same bits together with others and alone, over lanes of every width.
void check_lanes(const Tape& tape, const std::vector<LinePiece>& lines) {
  const LineProgram program(tape);
  std::vector<LineWidth> widths{LineWidth::baseline};
  if (has_avx2()) widths.push_back(LineWidth::avx2);
  for (const Question question : {&LineProgram::enclose_pieces, &LineProgram::enclose_points,
                                  &LineProgram::enclose_zeros, &LineProgram::numbers}) {
    const std::vector<double> together = answers(program, question, lines);
    for (const LineWidth width : widths)
      require_same(together, 0, answers(LineProgram(tape, width), question, lines));
    for (std::size_t i = 0; i < lines.size(); ++i)
      require_same(together, 5 * i, answers(program, question, {lines[i]}));
  }
}

Place on(const LinePiece& line, double s) {
  Place place;
  for (std::size_t v = 0; v < variables; ++v) place[v] = line.origin[v] + s * line.direction[v];
  return place;
}

/// Bounds and forms over pieces of a line hold the values on it.
void check_pieces(const Tape& tape, const LinePiece& line) {
  const VariableLine along{line.origin, line.direction};
  for (double length = line.to - line.from; length > 1e-17; length *= 0x1p-9) {
    const double to = line.from + length;
    const IntervalSlope piece = enclose(tape, along, line.from, to);
    require(piece.slope.lower <= piece.slope.upper, "a slope is empty");
    const ZeroRegion zeros = enclose_zeros(tape, along, line.from, to);
    require(zeros.empty() || (zeros.first >= line.from && zeros.last <= to), "zeros are outside the piece");
    for (const double part : {0.0, 0.3, 0.7, 1.0}) {
      const double s = std::min(to, line.from + part * length);
      const double value = value_at(tape, on(line, s));
      check_holds(piece.value, value);
      const Interval there = enclose(tape, along, s);
      check_holds(there, value);
      const int sign = there.continuity >= Continuity::partial ? 0
                       : there.lower > 0.0                     ? 1
                       : there.upper < 0.0                     ? -1
                                                               : 0;
      if (sign == 0 || zeros.continuity >= Continuity::defined) continue;
      require(!zeros.empty() || sign == zeros.sign, "a form has another sign");
    }
  }
}

int sign_at(const Tape& tape, const LinePiece& line, double s) {
  const Interval value = enclose(tape, {line.origin, line.direction}, s);
  if (value.continuity != Continuity::continuous) return 0;
  return value.lower > 1e-280 ? 1 : value.upper < -1e-280 ? -1 : 0;  // not where doubles underflow
}

/// No search misses a root that is certain to be there, and each ends.
void check_searches(const ImplicitFormula& f, const LinePiece& line) {
  const Tape& tape = f.expression().tape();
  std::vector<Root> roots;
  RootWalk walk(f, line);
  for (Root root; roots.size() < 30000 && walk.next(root);) roots.push_back(root);
  require(walk.work().cells < 80000, "a walk is too long");
  require(roots.size() < 30000, "roots do not end");
  std::vector<double> first;
  for (const RootFinder finder : {RootFinder::interval, RootFinder::affine, RootFinder::polynomial}) {
    Root root;
    first_roots(f, {&line, 1}, {&root, 1}, finder);
    first.push_back(root.t);
  }
  constexpr int samples = 64;
  const double step = (line.to - line.from) / samples;
  bool is_first = true;
  for (int i = 0; i < samples; ++i) {
    const double from = line.from + i * step;
    const double to = from + step;
    if (sign_at(tape, line, from) * sign_at(tape, line, to) >= 0) continue;
    // Beyond doubles nothing is claimed.
    const Interval between = enclose(tape, {line.origin, line.direction}, from, to).value;
    if (between.continuity != Continuity::continuous || std::isinf(between.lower) ||
        std::isinf(between.upper)) {
      continue;
    }
    // Nor where f is little but its own rounding, as waves are that no double tells apart.
    const Interval middle = enclose(tape, {line.origin, line.direction}, from + 0.381966 * step);
    if (!(middle.upper - middle.lower <= 1e-3 * (between.upper - between.lower))) continue;
    bool known = false;
    for (const Root& root : roots) known = known || (root.lower <= to && root.upper >= from);
    require(known, "a root is missed by the walk");
    for (const double t : first)
      require(!is_first || t <= to || roots.front().kind == RootKind::unresolved, "a root is missed");
    is_first = false;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const bool as_text = size > 0 && data[0] == '=';
  formula_text = as_text ? bytes.text('\n').substr(1) : some_formula(bytes, 1 + bytes.below(4));
  const auto parsed = Expression::parse(formula_text, {"x", "y", "z", "t"});
  if (std::get_if<Expression>(&parsed) == nullptr) return 0;
  const ImplicitFormula f(std::get<Expression>(parsed));
  const Tape& tape = f.expression().tape();
  for (int i = 0; i < 3; ++i) check_box(tape, bytes);
  std::vector<LinePiece> lines;
  for (int i = 0; i < 3; ++i) lines.push_back(some_line(bytes));
  lines.push_back({{{0.1, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, -1.0, 1.0});
  check_lanes(tape, lines);
  for (const LinePiece& line : lines) check_pieces(tape, line);
  for (const LinePiece& line : lines) check_searches(f, line);
  choose_root_finder(f, Vec3{-1.0}, Vec3{1.0});
  if (tape.instructions.size() < 5) prove_bounds(f);
  return 0;
}
