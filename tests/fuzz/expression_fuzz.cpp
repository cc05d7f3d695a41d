// libFuzzer entry: any bytes are an expression or an error whose caret lies in the text; and the evaluators
// of an expression agree with each other. tests/fuzz/corpus holds inputs that are worth keeping: ctest runs
// them too.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "backlight/expression/affine.h"
#include "backlight/expression/enclosure.h"
#include "backlight/expression/expression.h"

namespace {

using namespace backlight;

void require(bool fact, const char* what) {
  if (fact) return;
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// The bounds over a box hold the value at its corners and in its middle.
void check_box(const Expression& f, const std::vector<double>& low, const std::vector<double>& high) {
  std::vector<Interval> box;
  for (std::size_t i = 0; i < low.size(); ++i) box.push_back({low[i], high[i], Continuity::continuous});
  const Interval range = enclose(f.tape(), box);
  require(range.continuity == Continuity::undefined || range.lower <= range.upper, "an interval is empty");
  for (int corner = 0; corner < 9; ++corner) {
    std::vector<double> at;
    for (std::size_t i = 0; i < low.size(); ++i) {
      at.push_back(corner == 8 ? 0.5 * (low[i] + high[i]) : (corner >> i & 1) != 0 ? high[i] : low[i]);
    }
    const double value = f.evaluate(at);
    // Infinities and what is made of them are no real numbers, of which alone intervals speak.
    if (!std::isfinite(value) || range.continuity >= Continuity::partial) continue;
    require(range.contains(value), "a value is outside its bounds");
  }
}

void check_line(const Expression& f, const std::vector<double>& origin,
                const std::vector<double>& direction) {
  const VariableLine line{origin, direction};
  const IntervalSlope cell = enclose(f.tape(), line, -0.5, 0.25);
  const Interval middle = enclose(f.tape(), line, 0.125);
  require(cell.slope.lower <= cell.slope.upper, "a slope is empty");
  // Where numbers are beyond doubles there may be no value, as of infinity less infinity.
  if (cell.value.continuity != Continuity::continuous || middle.continuity == Continuity::undefined) return;
  require(middle.lower >= cell.value.lower && middle.upper <= cell.value.upper,
          "a point is outside its cell");
  require(middle.continuity == Continuity::continuous, "a point of a continuous cell is not");
}

/// The form of a piece holds the values at its points, and no zero is outside the region that it leaves.
void check_form(const Expression& f, const std::vector<double>& origin,
                const std::vector<double>& direction) {
  const VariableLine line{origin, direction};
  const double from = -0.5;
  const double to = 0.25;
  const AffineForm form = enclose_affine(f.tape(), line, from, to);
  require(!std::isnan(form.centre) && !std::isnan(form.slope) && form.error >= 0.0, "a form is not one");
  if (form.continuity >= Continuity::defined || std::isinf(form.error)) return;
  const ZeroRegion zeros = enclose_zeros(f.tape(), line, from, to);
  require(zeros.empty() || (zeros.first >= from && zeros.last <= to), "zeros are outside the piece");
  for (const double part : {-1.0, -0.5, 0.0, 0.25, 1.0}) {
    const double s = -0.125 + 0.375 * part;  // exact
    const Interval value = enclose(f.tape(), line, s);
    if (value.continuity == Continuity::undefined) continue;  // as in check_line()
    const double middle = form.centre + part * form.slope;
    const double room = 4e-16 * (std::abs(form.centre) + std::abs(form.slope) + form.error);
    require(value.lower <= middle + form.error + room && value.upper >= middle - form.error - room,
            "a value is outside its form");
    const int sign = value.lower > 0.0 ? 1 : value.upper < 0.0 ? -1 : 0;
    const bool before = zeros.empty() || s < zeros.first;
    require(!before || sign == 0 || sign == zeros.sign, "a sign before the zeros is another one");
    require(zeros.empty() || s <= zeros.last || sign == 0 || sign == -zeros.sign,
            "a sign behind the zeros is another one");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto result = Expression::parse(text, {"t", "frame", "x"});
  if (const auto* error = std::get_if<ExpressionError>(&result)) {
    require(error->column >= 1 && static_cast<std::size_t>(error->column) <= size + 1, "a column is outside");
    require(error->length >= 1 && !error->message.empty(), "an error says nothing");
    return 0;
  }
  const auto& expression = std::get<Expression>(result);
  const std::vector<double> values{0.5, 2.0, -1.0};
  const double value = expression.evaluate(values);
  const auto constant = expression.constant();
  require(!constant || *constant == value || std::isnan(value), "a constant has another value");
  const Dual dual = expression.evaluate(std::vector<Dual>{{0.5, 1.0}, {2.0, 0.0}, {-1.0, -2.0}});
  require(dual.value == value || std::isnan(value), "a value with its derivative is another one");
  const double bound = expression.bind(1, std::vector<double>{2.0, -1.0}).evaluate(std::vector<double>{0.5});
  require(std::isnan(bound) == std::isnan(value), "binding a parameter changes what is defined");
  check_box(expression, {0.5, 2.0, -1.0}, {0.5, 2.0, -1.0});
  check_box(expression, {-0.25, 1.0, -2.0}, {0.75, 3.0, -0.5});
  check_line(expression, {0.3, -1.0, 2.0}, {1.0, 0.5, -3.0});
  check_form(expression, {0.3, -1.0, 2.0}, {1.0, 0.5, -3.0});
  check_form(expression, {0.0, 0.5, 1.0}, {0.125, 0.0, 1e-6});
  return 0;
}
