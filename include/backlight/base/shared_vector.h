// A sequence that does not change, and that its copies share.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace backlight {

/// Made of a vector once, then only read, from any number of threads; to copy it is to copy a pointer.
template <class T>
class SharedVector {
 public:
  using value_type = T;
  using const_iterator = typename std::vector<T>::const_iterator;

  SharedVector() = default;
  /// Not explicit: a vector is given where a sequence is asked for.
  SharedVector(std::vector<T> values) : values_(std::make_shared<const std::vector<T>>(std::move(values))) {}

  [[nodiscard]] std::size_t size() const { return all().size(); }
  [[nodiscard]] bool empty() const { return all().empty(); }
  [[nodiscard]] const T& operator[](std::size_t i) const { return all()[i]; }
  [[nodiscard]] const T& front() const { return all().front(); }
  [[nodiscard]] const T& back() const { return all().back(); }
  [[nodiscard]] const_iterator begin() const { return all().begin(); }
  [[nodiscard]] const_iterator end() const { return all().end(); }

  friend bool operator==(const SharedVector& a, const std::vector<T>& b) { return a.all() == b; }

 private:
  [[nodiscard]] const std::vector<T>& all() const {
    static const std::vector<T> none;
    return values_ ? *values_ : none;
  }

  std::shared_ptr<const std::vector<T>> values_;
};

}  // namespace backlight
