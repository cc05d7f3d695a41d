// The processor's rounding mode, for the files that are compiled with -frounding-math.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace backlight {

/// Rounds towards +infinity while it lives. Also clears the processor's exception flags when it begins, and
/// puts everything back.
class RoundUp {
 public:
#if defined(__SSE2__)
  RoundUp() : saved_(_mm_getcsr()) {
    _mm_setcsr((saved_ & ~unsigned{_MM_ROUND_MASK | _MM_EXCEPT_MASK}) | _MM_ROUND_UP);
  }
  ~RoundUp() {
    _mm_setcsr(saved_);
  }

  /// Whether an overflow, an invalid operation or a division by zero has happened.
  [[nodiscard]] bool failed() const {
    return (_mm_getcsr() & (_MM_EXCEPT_OVERFLOW | _MM_EXCEPT_INVALID | _MM_EXCEPT_DIV_ZERO)) != 0;
  }

 private:
  unsigned saved_;
#else
  RoundUp() {
    std::feholdexcept(&saved_);
    std::fesetround(FE_UPWARD);
  }
  ~RoundUp() {
    std::fesetenv(&saved_);
  }

  [[nodiscard]] bool failed() const {
    return std::fetestexcept(FE_OVERFLOW | FE_INVALID | FE_DIVBYZERO) != 0;
  }

 private:
  std::fenv_t saved_;
#endif

 public:
  RoundUp(const RoundUp&) = delete;
  RoundUp& operator=(const RoundUp&) = delete;
};

/// Makes RoundUp::failed() true.
inline void raise_invalid() {
#if defined(__SSE2__)
  _mm_setcsr(_mm_getcsr() | _MM_EXCEPT_INVALID);
#else
  std::feraiseexcept(FE_INVALID);
#endif
}

/// Calls a function of the C library in the mode it is most accurate in. Through a pointer, so that the
/// compiler can neither evaluate the call itself nor move it past the change of mode.
template <class... Arguments>
[[gnu::noinline]] double at_nearest(double (*function)(Arguments...), Arguments... arguments) {
#if defined(__SSE2__)
  const unsigned mode = _mm_getcsr();
  _mm_setcsr(mode & ~unsigned{_MM_ROUND_MASK});
  const double result = function(arguments...);
  _mm_setcsr(mode);
#else
  const int mode = std::fegetround();
  std::fesetround(FE_TONEAREST);
  const double result = function(arguments...);
  std::fesetround(mode);
#endif
  return result;
}

}  // namespace backlight
