#include "backlight/render/partial_image.h"

#include <algorithm>
#include <utility>

namespace backlight {

PartialImage::PartialImage(ImageLayout layout, int band_rows, bool keeps_rows)
    : layout_(std::move(layout)),
      band_rows_(band_rows),
      keeps_rows_(keeps_rows),
      places_(static_cast<std::size_t>((layout_.data.height() + band_rows - 1) / band_rows)) {}

std::size_t PartialImage::view_count() const {
  return std::max<std::size_t>(layout_.views.size(), 1);
}

PixelBox PartialImage::band_window(std::size_t band) const {
  const int y = layout_.data.y0 + static_cast<int>(band) * band_rows_;
  return {layout_.data.x0, y, layout_.data.x1, std::min(y + band_rows_, layout_.data.y1)};
}

std::size_t PartialImage::band_of(int row) const {
  return static_cast<std::size_t>((row - layout_.data.y0) / band_rows_);
}

// With the lock. A spare one has the pixels of another band: they are of no meaning.
std::unique_ptr<RowBand> PartialImage::make_band(std::size_t band) {
  const PixelBox window = band_window(band);
  std::unique_ptr<RowBand> made;
  if (!spare_.empty() && window.height() == band_rows_) {
    made = std::move(spare_.back());
    spare_.pop_back();
    made->image.move_to(window);
  } else {
    made = std::make_unique<RowBand>();
    made->image = Image({layout_.display, window, layout_.channels, layout_.views});
    made->done.resize(view_count());
  }
  const std::size_t pixels = made->image.plane(0).size();
  for (std::vector<std::uint8_t>& plane : made->done) plane.assign(pixels, 0);
  made->missing = pixels * view_count();
  return made;
}

bool PartialImage::is_done(const Place& place) {
  return place.was_released || (place.band && place.band->missing == 0);
}

RowBand* PartialImage::begin(std::size_t band) {
  const std::lock_guard lock(guard_);
  if (is_done(places_[band])) return nullptr;
  if (!places_[band].band) places_[band].band = make_band(band);
  return places_[band].band.get();
}

const RowBand* PartialImage::find(std::size_t band) const {
  const std::lock_guard lock(guard_);
  return places_[band].band.get();
}

bool PartialImage::was_released(std::size_t band) const {
  const std::lock_guard lock(guard_);
  return places_[band].was_released;
}

bool PartialImage::is_finished(std::size_t band) const {
  const std::lock_guard lock(guard_);
  return is_done(places_[band]);
}

void PartialImage::release(std::size_t band) {
  if (keeps_rows_) return;
  const std::lock_guard lock(guard_);
  Place& place = places_[band];
  place.was_released = true;
  if (band_window(band).height() == band_rows_) spare_.push_back(std::move(place.band));
  place.band.reset();
}

bool PartialImage::is_complete() const {
  const std::lock_guard lock(guard_);
  return std::ranges::all_of(places_, is_done);
}

bool PartialImage::has_any() const {
  const std::lock_guard lock(guard_);
  return std::ranges::any_of(places_, [this](const Place& place) {
    if (!place.band) return place.was_released;
    return place.band->missing < place.band->image.plane(0).size() * view_count();
  });
}

void PartialImage::forget() {
  const std::lock_guard lock(guard_);
  for (Place& place : places_) place = {};
}

Image PartialImage::whole() const {
  Image image(layout_);
  for (std::size_t band = 0; band < band_count(); ++band) {
    const RowBand* begun = find(band);
    if (begun == nullptr) continue;
    const std::size_t first = image.offset(layout_.data.x0, band_window(band).y0);
    for (std::size_t channel = 0; channel < image.channel_count(); ++channel)
      std::ranges::copy(begun->image.plane(channel),
                        image.plane(channel).begin() + static_cast<std::ptrdiff_t>(first));
  }
  return image;
}

}  // namespace backlight
