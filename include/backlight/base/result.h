// A value, or the reason why there is none. For what depends on the world outside (files, libraries loaded
// on demand), where failing is ordinary and the caller decides what it means.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace backlight {

/// Why something could not be done: a whole sentence without a full stop, with the path it is about.
struct Failure {
  std::string message;
};

/// A `T` or a `Failure`. `value()` needs `ok()`, `error()` needs `!ok()`; std::bad_variant_access otherwise.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
  Result(Failure failure) : state_(std::in_place_index<1>, std::move(failure)) {}

  [[nodiscard]] bool ok() const { return state_.index() == 0; }
  [[nodiscard]] T& value() & { return std::get<0>(state_); }
  [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
  [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
  [[nodiscard]] const std::string& error() const { return std::get<1>(state_).message; }
  /// The failure, to be returned as another type of result.
  [[nodiscard]] Failure failure() const { return std::get<1>(state_); }

 private:
  std::variant<T, Failure> state_;
};

/// Success, or a `Failure`. `error()` of a success is empty.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Failure failure) : failure_(std::move(failure)) {}

  [[nodiscard]] bool ok() const { return !failure_.has_value(); }
  [[nodiscard]] std::string error() const { return failure_ ? failure_->message : std::string{}; }
  [[nodiscard]] Failure failure() const { return failure_.value(); }

 private:
  std::optional<Failure> failure_;
};

}  // namespace backlight
