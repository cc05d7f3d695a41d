#include "backlight/expression/line_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "backlight/base/instruction_sets.h"
#include "backlight/expression/affine.h"
#include "backlight/expression/enclosure.h"
#include "line_work.h"
#include "rounding.h"

namespace backlight {
namespace {

LineKernels widest() {
  if (has_good_avx512() && avx512_line_kernels().pieces != nullptr) return avx512_line_kernels();
  if (has_avx2() && avx2_line_kernels().pieces != nullptr) return avx2_line_kernels();
  return baseline_line_kernels();
}

const LineKernels& kernels(LineWidth width) {
  static const std::array<LineKernels, 3> all{widest(), baseline_line_kernels(), avx2_line_kernels()};
  return all[static_cast<std::size_t>(width)];
}

std::size_t padded(std::size_t count) {
  return (count + LineBatch::padding - 1) / LineBatch::padding * LineBatch::padding;
}

/// The spare lines at the end do what the last one does.
void fill_up(LineBatch& lines, std::size_t count) {
  for (std::size_t i = count; i < padded(count); ++i) {
    for (std::size_t v = 0; v < LineBatch::most_variables; ++v) {
      lines.origin(v)[i] = lines.origin(v)[count - 1];
      lines.direction(v)[i] = lines.direction(v)[count - 1];
    }
    lines.from()[i] = lines.from()[count - 1];
    lines.to()[i] = lines.to()[count - 1];
  }
}

enum class Question { piece, point, zeros, forms };

/// Runs the kernels of one question on the first `count` lines, a multiple of the padding.
class Run {
 public:
  Run(const LineProgram& program, LineBatch& lines, std::vector<double>& workspace)
      : program_(program), kernels_(kernels(program.width())), lines_(lines), workspace_(workspace) {}

  /// False: some line was in trouble, and nothing found is to be trusted.
  [[gnu::noinline]] bool bounds(Question question, std::size_t count) {
    const LineWork work = work_on(count, question == Question::point);
    const RoundUp mode;
    kernel_of(question)(work);
    return !mode.failed();
  }

  void numbers(std::size_t count) { kernels_.numbers(work_on(count, true)); }

  void polynomials(std::size_t count, LinePolynomials& found) {
    // The registers of one kernel's width at a time, and two more for powers.
    const std::size_t registers = program_.tape().registers + 2;
    const std::size_t needed = registers * (LinePolynomials::most_degree + 2) * LineBatch::padding;
    if (workspace_.size() < needed) workspace_.resize(needed);
    kernels_.polynomials(work_on(count, false), found);
  }

  [[nodiscard]] const double* result(std::size_t component, std::size_t count) const {
    return workspace_.data() + component * count;
  }

 private:
  [[nodiscard]] auto kernel_of(Question question) const -> void (*)(const LineWork&) {
    if (question == Question::zeros) return kernels_.zeros;
    if (question == Question::forms) return kernels_.forms;
    return question == Question::piece ? kernels_.pieces : kernels_.points;
  }

  LineWork work_on(std::size_t count, bool at_point) {
    LineWork work;
    work.steps = program_.steps().data();
    work.step_count = program_.steps().size();
    work.constants = program_.tape().constants.data();
    for (std::size_t v = 0; v < LineBatch::most_variables; ++v) {
      work.origin[v] = lines_.origin(v);
      work.direction[v] = lines_.direction(v);
    }
    work.from = lines_.from();
    work.to = at_point ? lines_.from() : lines_.to();
    if (workspace_.size() < program_.workspace(count)) workspace_.resize(program_.workspace(count));
    work.registers = workspace_.data();
    work.register_count = static_cast<std::uint32_t>(program_.tape().registers);
    work.found[0] = lines_.first_zero();
    work.found[1] = lines_.last_zero();
    work.found[2] = lines_.sign();
    work.stride = count;
    return work;
  }

  const LineProgram& program_;
  const LineKernels& kernels_;
  LineBatch& lines_;
  std::vector<double>& workspace_;
};

/// One line by the arithmetic with all special cases.
void enclose_carefully(const LineProgram& program, LineBatch& lines, std::size_t i, Question question) {
  std::array<double, LineBatch::most_variables> origin{};
  std::array<double, LineBatch::most_variables> direction{};
  for (std::size_t v = 0; v < LineBatch::most_variables; ++v) {
    origin[v] = lines.origin(v)[i];
    direction[v] = lines.direction(v)[i];
  }
  const VariableLine line{origin, direction};
  if (question == Question::zeros) {
    const ZeroRegion zeros = enclose_zeros(program.tape(), line, lines.from()[i], lines.to()[i]);
    lines.first_zero()[i] = zeros.first;
    lines.last_zero()[i] = zeros.last;
    lines.sign()[i] = zeros.sign;
    lines.continuity()[i] = static_cast<double>(zeros.continuity);
    return;
  }
  if (question == Question::point) {
    const Interval value = enclose(program.tape(), line, lines.from()[i]);
    lines.lower()[i] = value.lower;
    lines.upper()[i] = value.upper;
    lines.continuity()[i] = static_cast<double>(value.continuity);
    return;
  }
  const IntervalSlope piece = enclose(program.tape(), line, lines.from()[i], lines.to()[i]);
  lines.lower()[i] = piece.value.lower;
  lines.upper()[i] = piece.value.upper;
  lines.slope_lower()[i] = piece.slope.lower;
  lines.slope_upper()[i] = piece.slope.upper;
  lines.continuity()[i] = static_cast<double>(piece.value.continuity);
}

void take(const Run& run, LineBatch& lines, std::size_t count, std::size_t wanted, Question question) {
  std::fill_n(lines.continuity(), wanted, 0.0);
  if (question == Question::zeros) return;  // the kernel wrote them where they belong
  for (std::size_t i = 0; i < wanted; ++i) {
    lines.lower()[i] = -run.result(0, count)[i];
    lines.upper()[i] = run.result(1, count)[i];
    if (question == Question::piece) {
      lines.slope_lower()[i] = -run.result(2, count)[i];
      lines.slope_upper()[i] = run.result(3, count)[i];
    }
  }
}

/// Result r of some lines, into those from `first` on.
void take_form(const Run& run, std::size_t stride, std::size_t r, const LineForms& form, std::size_t first,
               std::size_t count) {
  std::copy_n(run.result(3 * r, stride), count, form.centre + first);
  std::copy_n(run.result(3 * r + 1, stride), count, form.slope + first);
  std::copy_n(run.result(3 * r + 2, stride), count, form.error + first);
}

void copy_question(LineBatch& from, std::size_t i, LineBatch& to, std::size_t k) {
  for (std::size_t v = 0; v < LineBatch::most_variables; ++v) {
    to.origin(v)[k] = from.origin(v)[i];
    to.direction(v)[k] = from.direction(v)[i];
  }
  to.from()[k] = from.from()[i];
  to.to()[k] = from.to()[i];
}

void copy_answer(LineBatch& from, std::size_t k, LineBatch& to, std::size_t i) {
  for (auto array : {&LineBatch::lower, &LineBatch::upper, &LineBatch::slope_lower, &LineBatch::slope_upper,
                     &LineBatch::continuity}) {
    (to.*array)()[i] = (from.*array)()[k];
  }
}

/// Lines [first, last) by themselves; false: some line was in trouble.
bool enclose_apart(const LineProgram& program, LineBatch& lines, std::size_t first, std::size_t last,
                   std::vector<double>& workspace, Question question) {
  LineBatch apart(LineBatch::padding);
  for (std::size_t i = first; i < last; ++i) copy_question(lines, i, apart, i - first);
  fill_up(apart, last - first);
  Run run(program, apart, workspace);
  if (!run.bounds(question, LineBatch::padding)) return false;
  take(run, apart, LineBatch::padding, last - first, question);
  for (std::size_t i = first; i < last; ++i) copy_answer(apart, i - first, lines, i);
  return true;
}

/// Where one line of a batch is in trouble, a few and then each are asked by themselves: what is found of a
/// line never depends on the others.
void enclose_lines(const LineProgram& program, LineBatch& lines, std::size_t count,
                   std::vector<double>& workspace, Question question) {
  if (count == 0) return;
  fill_up(lines, count);
  Run run(program, lines, workspace);
  if (run.bounds(question, padded(count))) {
    take(run, lines, padded(count), count, question);
    return;
  }
  for (std::size_t few = 0; few < count; few += LineBatch::padding) {
    const std::size_t end = std::min(count, few + LineBatch::padding);
    if (enclose_apart(program, lines, few, end, workspace, question)) continue;
    for (std::size_t i = few; i < end; ++i) {
      if (!enclose_apart(program, lines, i, i + 1, workspace, question)) {
        enclose_carefully(program, lines, i, question);
      }
    }
  }
}

/// Of the result of a step; `exponent` is that of a whole power.
std::uint8_t degree_of(const LineProgram::Step& step, double exponent) {
  constexpr int none = LineProgram::Step::none;
  const bool binary = info(step.operation).operands == 2;
  if (step.degree_a == none || (binary && step.degree_b == none)) return none;
  const auto result = [&]() -> int {
    switch (step.operation) {
      case Operation::add:
      case Operation::subtract:
        return std::max(step.degree_a, step.degree_b);
      case Operation::multiply:
        return step.degree_a + step.degree_b;
      case Operation::divide:
        return step.constant_b ? step.degree_a : none;
      case Operation::negate:
        return step.degree_a;
      case Operation::square:
        return 2 * step.degree_a;
      case Operation::integer_power:
        return exponent <= LinePolynomials::most_degree ? step.degree_a * static_cast<int>(exponent) : none;
      default:
        return none;
    }
  }();
  return static_cast<std::uint8_t>(result <= LinePolynomials::most_degree ? result : none);
}

}  // namespace

LineBatch::LineBatch(std::size_t capacity) : capacity_(padded(capacity)), numbers_(15 * capacity_, 0.0) {}

LineProgram::LineProgram(const Tape& tape, LineWidth width) : tape_(tape), width_(width) {
  std::vector<bool> changes(tape.registers, false);
  std::vector<bool> constant(tape.registers, false);
  std::vector<std::uint8_t> degree(tape.registers, Step::none);
  std::vector<double> number(tape.registers, 0.0);
  steps_.reserve(tape.instructions.size());
  for (const Instruction& step : tape.instructions) {
    LineProgram::Step line{step.operation, false, false, step.out, step.a, step.b};
    if (step.operation == Operation::variable) {
      if (step.a >= LineBatch::most_variables) throw std::invalid_argument("LineProgram: too many variables");
      changes[step.out] = true;
      line.degree = 1;
    } else if (step.operation == Operation::constant) {
      changes[step.out] = false;
      line.degree = 0;
      number[step.out] = tape.constants[step.a];
    } else {
      line.slope_a = changes[step.a];
      line.slope_b = info(step.operation).operands == 2 && changes[step.b];
      line.constant_a = constant[step.a];
      line.constant_b = info(step.operation).operands == 2 && constant[step.b];
      changes[step.out] = line.slope_a || line.slope_b;
      line.degree_a = degree[step.a];
      line.degree_b = degree[step.b];
      line.degree = degree_of(line, number[step.b]);
    }
    degree[step.out] = line.degree;
    constant[step.out] = step.operation == Operation::constant;
    steps_.push_back(line);
  }
}

std::optional<int> LineProgram::degree() const {
  const std::uint8_t last = steps_.back().degree;
  if (last == Step::none) return std::nullopt;
  return last;
}

void LineProgram::polynomials(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
                              LinePolynomials& found) const {
  if (count == 0) return;
  fill_up(lines, count);
  Run(*this, lines, workspace).polynomials(padded(count), found);
}

std::size_t LineProgram::workspace(std::size_t count) const {
  return tape_.registers * 4 * padded(count);
}

void LineProgram::enclose_pieces(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const {
  enclose_lines(*this, lines, count, workspace, Question::piece);
}

void LineProgram::enclose_zeros(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const {
  enclose_lines(*this, lines, count, workspace, Question::zeros);
}

void LineProgram::enclose_points(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const {
  enclose_lines(*this, lines, count, workspace, Question::point);
}

void LineProgram::numbers(LineBatch& lines, std::size_t count, std::vector<double>& workspace) const {
  const LineNumbers only{lines.value(), lines.slope()};
  all_numbers(lines, count, workspace, {&only, 1});
}

void LineProgram::all_numbers(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
                              std::span<const LineNumbers> results) const {
  if (count == 0) return;
  fill_up(lines, count);
  Run run(*this, lines, workspace);
  run.numbers(padded(count));
  for (std::size_t r = 0; r < results.size(); ++r) {
    std::copy_n(run.result(2 * r, padded(count)), count, results[r].value);
    std::copy_n(run.result(2 * r + 1, padded(count)), count, results[r].slope);
  }
}

void LineProgram::forms(LineBatch& lines, std::size_t count, std::vector<double>& workspace,
                        std::span<const LineForms> results) const {
  if (count == 0) return;
  fill_up(lines, count);
  if (Run run(*this, lines, workspace); run.bounds(Question::forms, padded(count))) {
    for (std::size_t r = 0; r < results.size(); ++r) take_form(run, padded(count), r, results[r], 0, count);
    return;
  }
  // What is found of a line never depends on the others.
  LineBatch one(LineBatch::padding);
  for (std::size_t i = 0; i < count; ++i) {
    copy_question(lines, i, one, 0);
    fill_up(one, 1);
    Run run(*this, one, workspace);
    const bool good = run.bounds(Question::forms, LineBatch::padding);
    for (std::size_t r = 0; r < results.size(); ++r) {
      take_form(run, LineBatch::padding, r, results[r], i, 1);
      if (good) continue;
      results[r].centre[i] = results[r].slope[i] = 0.0;
      results[r].error[i] = std::numeric_limits<double>::infinity();
    }
  }
}

}  // namespace backlight
