#include "backlight/colour/shifted_daylight.h"

#include <bit>
#include <utility>

#include "backlight/colour/spectrum.h"

namespace backlight {
namespace {

constexpr double least_shift = 0.125;
constexpr double end_of_shifts = 8.0;

// The first eleven bits of a shift's fraction, and its exponent, say which row is at or below it.
constexpr int bits_below_row = 41;

constexpr std::uint64_t row_bits(double shift) {
  return std::bit_cast<std::uint64_t>(shift) >> bits_below_row;
}

constexpr std::size_t row_count = row_bits(end_of_shifts) - row_bits(least_shift) + 1;

double shift_of_row(std::size_t index) {
  return std::bit_cast<double>((row_bits(least_shift) + index) << bits_below_row);
}

}  // namespace

ShiftedDaylight::ShiftedDaylight(std::vector<double> nm, std::vector<double> red, std::vector<double> green,
                                 std::vector<double> blue)
    : nm_(std::move(nm)),
      red_(std::move(red)),
      green_(std::move(green)),
      blue_(std::move(blue)),
      rows_(row_count) {}

ShiftedDaylight::~ShiftedDaylight() {
  for (std::atomic<const Row*>& row : rows_) delete row.load(std::memory_order_relaxed);
}

std::optional<ShiftedDaylight::Place> ShiftedDaylight::at(double shift) const {
  if (!(shift >= least_shift && shift < end_of_shifts)) return {};
  const std::size_t index = row_bits(shift) - row_bits(least_shift);
  const double low = shift_of_row(index);
  return Place{&row(index), &row(index + 1), (shift - low) / (shift_of_row(index + 1) - low)};
}

const ShiftedDaylight::Row& ShiftedDaylight::row(std::size_t index) const {
  std::atomic<const Row*>& place = rows_[index];
  if (const Row* made = place.load(std::memory_order_acquire)) return *made;
  // Two threads may make the same row; the one that comes second takes the first's.
  std::unique_ptr<const Row> row = make_row(index);
  const Row* first = nullptr;
  if (place.compare_exchange_strong(first, row.get(), std::memory_order_acq_rel)) return *row.release();
  return *first;
}

std::unique_ptr<const ShiftedDaylight::Row> ShiftedDaylight::make_row(std::size_t index) const {
  static const SpectralKernels& kernels = spectral_kernels(InstructionSet::widest);
  static const Spectrum daylight = Spectrum::d65();
  const double shift = shift_of_row(index);
  const int count = static_cast<int>(nm_.size());
  auto row = std::make_unique<Row>();
  row->values.resize(nm_.size());
  std::vector<double> at(nm_);
  for (double& nm : at) nm *= shift;
  daylight.evaluate(at.data(), count, row->values.data(), kernels);
  double colour[3];
  kernels.film({red_.data(), green_.data(), blue_.data()}, row->values.data(), nullptr, count, colour);
  row->film = {colour[0], colour[1], colour[2]};
  return row;
}

}  // namespace backlight
