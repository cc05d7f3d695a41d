// An image while it is made: bands of rows, each in memory only while it is needed there.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "backlight/film/image.h"

namespace backlight {

/// Rows of an image, the whole width of it.
struct RowBand {
  Image image;  ///< its data window is the band. Only pixels that are done have a meaning
  /// A plane for each view, laid out as the image's: 1 where the pixel is final, 0 where it is still to be
  /// traced. Different threads may write different pixels.
  std::vector<std::vector<std::uint8_t>> done;
  std::atomic<std::size_t> missing{0};  ///< pixels, of all views, that are not done
};

/// The bands of an image from the top. One comes into being with its first pixel; when its rows are final and
/// in their file, it is released, and its memory serves the next. Where images are expensive (many samples a
/// pixel) all are kept, since rows that were rounded for the file cannot be stored as float any more.
class PartialImage {
 public:
  /// Nothing is done. All bands but the last have `band_rows` rows.
  PartialImage(ImageLayout layout, int band_rows, bool keeps_rows);

  [[nodiscard]] const ImageLayout& layout() const { return layout_; }
  [[nodiscard]] std::size_t view_count() const;
  [[nodiscard]] bool keeps_rows() const { return keeps_rows_; }
  [[nodiscard]] std::size_t band_count() const { return places_.size(); }
  [[nodiscard]] PixelBox band_window(std::size_t band) const;
  [[nodiscard]] std::size_t band_of(int row) const;

  /// A band that is not finished, for pixels to be put into it; null if it is. From any thread.
  RowBand* begin(std::size_t band);
  /// Null if it has not begun or was released. From any thread.
  [[nodiscard]] const RowBand* find(std::size_t band) const;
  [[nodiscard]] bool was_released(std::size_t band) const;
  /// Whether all its pixels are done. From any thread.
  [[nodiscard]] bool is_finished(std::size_t band) const;
  /// The rows of a finished band are in their file. Where rows are kept, nothing happens. From any thread.
  void release(std::size_t band);

  [[nodiscard]] bool is_complete() const;
  /// Whether any pixel is final.
  [[nodiscard]] bool has_any() const;

  /// Nothing is final any more.
  void forget();

  /// All of it, 0 where nothing was traced. No band may have been released.
  [[nodiscard]] Image whole() const;

 private:
  struct Place {
    std::unique_ptr<RowBand> band;
    bool was_released = false;
  };
  static bool is_done(const Place& place);
  [[nodiscard]] std::unique_ptr<RowBand> make_band(std::size_t band);

  ImageLayout layout_;
  int band_rows_;
  bool keeps_rows_;
  mutable std::mutex guard_;  // of what follows
  std::vector<Place> places_;
  std::vector<std::unique_ptr<RowBand>> spare_;  // of band_rows_ rows
};

}  // namespace backlight
