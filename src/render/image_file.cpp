#include "backlight/render/image_file.h"

#include <chrono>
#include <exception>
#include <new>
#include <utility>
#include <vector>

namespace backlight {

ImageFile::ImageFile(std::filesystem::path path, ExrHeader header, ColourStorage storage, PartialImage& image,
                     HelperThread* helper)
    : path_(std::move(path)),
      header_(std::move(header)),
      image_(image),
      helper_(helper),
      is_wide_(storage == ColourStorage::always_float) {}

ImageFile::~ImageFile() {
  settle();
}

// Keeps what goes wrong in `work`, for the commit.
template <class Work>
void ImageFile::guarded(const Work& work) {
  Result<void> done;
  bool lacks_memory = false;
  try {
    done = work();
  } catch (const std::bad_alloc&) {
    lacks_memory = true;
  }
  const std::lock_guard lock(guard_);
  if (!done.ok()) result_ = std::move(done);
  lacks_memory_ = lacks_memory_ || lacks_memory;
}

void ImageFile::take_finished() {
  while (const auto band = take_next()) {
    const auto begin = std::chrono::steady_clock::now();
    guarded([&] { return look_at(*band); });
    const bool is_for_helper = helper_ != nullptr && helper_->takes([this, band] { encode(*band); });
    if (!is_for_helper) encode(*band);
    const std::lock_guard lock(guard_);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }
}

std::optional<std::size_t> ImageFile::take_next() {
  const std::lock_guard lock(guard_);
  const bool is_ready = next_ < image_.band_count() && image_.is_finished(next_);
  if (!is_ready || is_to_begin_anew_ || fails()) return std::nullopt;
  ++in_hand_;
  return next_++;
}

Result<void> ImageFile::look_at(std::size_t band) {
  const ImageFaults seen = faults_of(image_.find(band)->image);
  const std::lock_guard lock(guard_);
  faults_ += seen;
  is_to_begin_anew_ = is_to_begin_anew_ || (seen.beyond_half > 0 && !is_wide_);
  return {};
}

void ImageFile::encode(std::size_t band) {
  guarded([&] { return encode_and_write(band); });
  const std::lock_guard lock(guard_);
  if (--in_hand_ == 0) is_idle_.notify_all();
}

Result<void> ImageFile::encode_and_write(std::size_t band) {
  std::unique_lock lock(guard_);
  if (is_to_begin_anew_ || fails()) return {};
  if (const auto begun = begin_file(); !begun.ok()) return begun;
  lock.unlock();
  const Image& image = image_.find(band)->image;
  std::vector<std::span<const float>> planes;
  for (std::size_t channel = 0; channel < image.channel_count(); ++channel)
    planes.push_back(image.plane(channel));
  auto rows = writer_->encode(image.layout().data.y0, planes, image.layout().data.height());
  if (!rows.ok()) return rows.failure();
  lock.lock();
  encoded_.emplace(band, std::move(rows).value());
  for (auto next = encoded_.find(written_); next != encoded_.end(); next = encoded_.find(written_)) {
    if (const auto done = writer_->write(next->second); !done.ok()) return done;
    encoded_.erase(next);
    image_.release(written_++);
  }
  return {};
}

// With the lock.
Result<void> ImageFile::begin_file() {
  if (writer_) return {};
  ImageLayout layout = image_.layout();
  if (is_wide_) widen(layout);
  auto opened = ExrWriter::open(path_, layout, header_);
  if (!opened.ok()) return opened.failure();
  writer_.emplace(std::move(opened).value());
  return {};
}

bool ImageFile::fails() const {
  return lacks_memory_ || !result_.ok();
}

bool ImageFile::is_lost() const {
  const std::lock_guard lock(guard_);
  return fails();
}

bool ImageFile::is_to_begin_anew() const {
  const std::lock_guard lock(guard_);
  return is_to_begin_anew_;
}

bool ImageFile::has_use_for_pixels() const {
  const std::lock_guard lock(guard_);
  return !fails() && (!is_to_begin_anew_ || image_.keeps_rows());
}

void ImageFile::begin_anew() {
  settle();
  writer_.reset();
  encoded_.clear();
  next_ = written_ = 0;
  is_wide_ = true;
  is_to_begin_anew_ = false;
  faults_ = {};
  if (!image_.keeps_rows()) image_.forget();
}

void ImageFile::settle() {
  std::unique_lock lock(guard_);
  is_idle_.wait(lock, [this] { return in_hand_ == 0; });
}

Result<void> ImageFile::read_back(std::size_t band, std::span<const std::span<float>> planes) {
  const PixelBox window = image_.band_window(band);
  return writer_->read_back(window.y0, planes, window.height());
}

Result<void> ImageFile::commit() {
  settle();
  if (lacks_memory_) throw std::bad_alloc();
  if (!result_.ok()) return result_;
  if (const auto begun = begin_file(); !begun.ok()) return begun;
  return writer_->commit();
}

bool ImageFile::is_half() const {
  return !is_wide_;
}

ImageFaults ImageFile::faults() const {
  const std::lock_guard lock(guard_);
  return faults_;
}

double ImageFile::seconds() const {
  const std::lock_guard lock(guard_);
  return seconds_;
}

}  // namespace backlight
