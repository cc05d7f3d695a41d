// The options of how pictures are shown, which are the same for view and for the PNGs of render.
#include <memory>

#include "command_table.h"

namespace backlight {
namespace {

// Stops; none are `auto`.
Result<std::optional<double>> parse_exposure(const std::string& text) {
  if (text == "auto") return std::optional<double>{};
  const auto stops = parse_number(text);
  if (!stops.ok()) return Failure{stops.error() + " or auto"};
  return std::optional{stops.value()};
}

}  // namespace

void add_display_rows(RowGroup& group, DisplayChoice& display, const std::string& needs) {
  const std::string of_pngs = needs.empty() ? "" : "of the PNGs: ";
  group
      .value("--exposure", "STOPS",
             of_pngs +
                 "brighten by a factor of 2 a stop, negative darkens; auto shows the log-average luminance "
                 "as middle grey",
             parse_exposure,
             [&display](std::optional<double> stops) {
               display.automatic_exposure = !stops;
               display.exposure_stops = stops;
             })
      .needs = needs;
  group
      .choice<std::optional<ToneCurve>>(
          "--tone", "CURVE",
          of_pngs +
              "what becomes of light beyond white. auto (the default): none if next to "
              "nothing is, else reinhard, or "
              "drago where many powers of ten are, exposed so that nothing is cut, and named "
              "on stderr; none: cut; "
              "drago: logarithm, exposed by itself; reinhard; log",
          {{"auto", std::nullopt},
           {"none", ToneCurve::none},
           {"drago", ToneCurve::drago},
           {"reinhard", ToneCurve::reinhard},
           {"log", ToneCurve::logarithmic}},
          display.tone)
      .needs = needs;
  group
      .value("--white", "L",
             of_pngs +
                 "luminance that the curve shows as white, after exposure; default 1000, for drago the "
                 "greatest",
             parse_number, display.white)
      .needs = needs;
}

Result<void> check_display(const DisplayChoice& display) {
  if (display.white && !(*display.white > 0.0)) return Failure{"--white: expected a number greater than 0"};
  return {};
}

void add_label_row(RowGroup& group, std::string& label, const std::string& needs) {
  group
      .value("--label", "TEXT",
             (needs.empty() ? "write this into each picture" : "write this into each PNG") +
                 std::string("; {time}, {frame}, {params.NAME}, {file} stand for what the image tells, "
                             "{time:.2} with two decimals"),
             parse_text, label)
      .needs = needs;
}

}  // namespace backlight
