// The file of an image that is being traced.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <span>

#include "backlight/base/helper_thread.h"
#include "backlight/base/result.h"
#include "backlight/film/exr.h"
#include "backlight/render/image_faults.h"
#include "backlight/render/partial_image.h"

namespace backlight {

/// Takes the bands of an image as they are finished, from the top: their faults are counted, they are rounded
/// and compressed by the threads that bring them, or by a helper beside those, and written in order into a
/// temporary, which takes the file's place at the commit. The bytes do not depend on who does what.
///
/// Colour is half until a value passes half's range, unless it is to be float in any case. What was written
/// before that is then of no use: the file begins anew, in float.
class ImageFile {
 public:
  /// `image` and `helper` (null: none) must outlive this. The file is made with its first rows.
  ImageFile(std::filesystem::path path, ExrHeader header, ColourStorage storage, PartialImage& image,
            HelperThread* helper);
  /// Without a commit nothing is left.
  ~ImageFile();
  ImageFile(const ImageFile&) = delete;
  ImageFile& operator=(const ImageFile&) = delete;

  /// Takes the bands that are next and finished. From any thread. What goes wrong is told by commit().
  void take_finished();

  /// Whether the file can no longer be written.
  [[nodiscard]] bool is_lost() const;

  /// Whether a value passed half's range, and begin_anew() is to be called.
  [[nodiscard]] bool is_to_begin_anew() const;

  /// Whether pixels that are traced now will come into the file. From any thread.
  [[nodiscard]] bool has_use_for_pixels() const;

  /// What was written is dropped, and colour is float from now on. Bands that the image did not keep are to
  /// be traced again, and the others to be taken again. While no other thread uses this or the image.
  void begin_anew();

  /// Waits until what was taken is written.
  void settle();

  /// Whether colour that was written is rounded to half. After settle().
  [[nodiscard]] bool is_half() const;

  /// The rows of a band that was written: planes in the order of the image's channels. After settle().
  Result<void> read_back(std::size_t band, std::span<const std::span<float>> planes);

  /// Completes the file and moves it to its place. Throws std::bad_alloc if memory was lacking, at any time.
  Result<void> commit();

  /// Of the bands that were taken.
  [[nodiscard]] ImageFaults faults() const;

  /// How long threads that called take_finished() were in it, in seconds.
  [[nodiscard]] double seconds() const;

 private:
  template <class Work>
  void guarded(const Work& work);
  std::optional<std::size_t> take_next();
  Result<void> look_at(std::size_t band);
  void encode(std::size_t band);
  Result<void> encode_and_write(std::size_t band);
  Result<void> begin_file();
  [[nodiscard]] bool fails() const;

  const std::filesystem::path path_;
  const ExrHeader header_;
  PartialImage& image_;
  HelperThread* const helper_;

  mutable std::mutex guard_;  // of all that follows
  std::condition_variable is_idle_;
  std::optional<ExrWriter> writer_;
  std::map<std::size_t, EncodedRows> encoded_;  // bands that wait for one before them to be written
  std::size_t next_ = 0;                        // band to be taken
  std::size_t written_ = 0;                     // bands
  std::size_t in_hand_ = 0;                     // bands that were taken and are not encoded
  bool is_wide_;                                // colour is float
  bool is_to_begin_anew_ = false;
  bool lacks_memory_ = false;
  Result<void> result_;
  ImageFaults faults_;
  double seconds_ = 0.0;
};

}  // namespace backlight
