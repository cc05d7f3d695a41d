// What is to be known of formulas about zero, whichever number type says it.
#pragma once

#include <map>
#include <string>

#include "backlight/expression/interval.h"

namespace backlight {

/// Each formula's continuity over x in [-0.5, 0.5].
inline const std::map<std::string, Continuity>& continuity_about_zero() {
  static const std::map<std::string, Continuity> flags{{"1/x", Continuity::partial},
                                                       {"tan(x + pi/2)", Continuity::partial},
                                                       {"floor(x)", Continuity::defined},
                                                       {"mod(x, 1)", Continuity::defined},
                                                       {"log(x)", Continuity::partial},
                                                       {"sqrt(x)", Continuity::partial},
                                                       {"asin(x + 1)", Continuity::partial},
                                                       {"x^0.5", Continuity::partial},
                                                       {"atan2(x, -1)", Continuity::defined},
                                                       {"atan2(x, x)", Continuity::partial},
                                                       {"log(-1 - x^2)", Continuity::undefined},
                                                       {"cbrt(x)", Continuity::continuous},
                                                       {"abs(x)", Continuity::continuous},
                                                       {"atan2(x, 1)", Continuity::continuous}};
  return flags;
}

}  // namespace backlight
