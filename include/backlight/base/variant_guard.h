// For variants that are copied where there may be no memory.
#pragma once

namespace backlight {

/// The last alternative of a variant of strings, vectors and plain types, which it never holds. The standard
/// library of gcc 12 takes such variants for ones that always have a value, and so destroys one that was not
/// made when there is no memory for a copy: it jumps anywhere. With an alternative whose copying is not
/// trivial, it looks.
struct VariantGuard {
  VariantGuard() = default;
  VariantGuard(const VariantGuard& /*other*/) noexcept {}
  VariantGuard& operator=(const VariantGuard& /*other*/) noexcept { return *this; }
  ~VariantGuard() = default;
};

}  // namespace backlight
