// Colours as three numbers: linear Rec.709, CIE XYZ, CIE L*a*b*, and how different two colours look.
#pragma once

#include "backlight/base/vector.h"

namespace backlight {

/// Scene-linear red, green, blue: the primaries of ITU-R BT.709, white D65 = (1, 1, 1). Components are
/// negative for colours outside the primaries' triangle, and have no upper bound.
using LinearRgb = Vec3;

/// CIE 1931 tristimulus values X, Y, Z, with Y = 1 for the white (1, 1, 1).
using Xyz = Vec3;

/// CIE 1976 L*, a*, b* relative to the D65 white.
using Lab = Vec3;

/// The matrix between the two follows from the primaries' chromaticities (0.64, 0.33), (0.30, 0.60), (0.15,
/// 0.06) and the white of the D65 table itself, x = 0.312727, y = 0.329023, of which Rec. 709's 0.3127,
/// 0.3290 are the rounded values: so a white surface under D65 has red = green = blue. (SMPTE RP 177 gives
/// the derivation.)
LinearRgb rgb_from_xyz(const Xyz& xyz);
Xyz xyz_from_rgb(const LinearRgb& rgb);

/// The luminance Y of a linear colour: 0.2126 R + 0.7152 G + 0.0722 B to four digits. "Film Y" in the
/// documentation.
double luminance(const LinearRgb& rgb);

/// X, Y, Z of the white (1, 1, 1).
Xyz white_xyz();

/// CIE 1976 L*a*b* (CIE 15) of a colour seen beside a white of luminance 1. Colours out of the gamut are
/// carried through by the formulas' linear part.
Lab lab_from_xyz(const Xyz& xyz);
Lab lab_from_rgb(const LinearRgb& rgb);

/// The colour difference CIEDE2000 with kL = kC = kH = 1 (Sharma, Wu & Dalal, Color Research & Application
/// 30(1), 2005, equations 2 to 22). About 1 is just noticeable between large patches side by side.
double delta_e_2000(const Lab& a, const Lab& b);

}  // namespace backlight
