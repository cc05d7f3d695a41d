// Sheets: the rays of a few neighbouring pixels as arrays, and the kernels over them.
//
// Plain numbers for the kernels' sake (base/lanes.h says why). What each step computes, and to what equation,
// is told by src/trace/tracer.cpp, illumination.cpp and shading.cpp for one ray; kernels do the same
// operation by operation, and tests/agreement compares the two bit for bit.
#pragma once

#include <array>
#include <cstdint>

#include "backlight/base/lanes.h"
#include "backlight/camera/sample_digits.h"
#include "backlight/film/lane_texture.h"
#include "backlight/surface/ray_sheet.h"
#include "backlight/trace/sheet_tracer.h"

namespace backlight {

struct Light;

/// `count` rounded up to whole registers of any width.
inline int padded_count(int count) {
  return (count + 7) / 8 * 8;
}

/// As many bits, from the lowest.
BACKLIGHT_LANES std::uint64_t first_bits(int count) {
  return count < 64 ? (std::uint64_t{1} << count) - 1 : ~std::uint64_t{0};
}

/// Λ = R B(w) of spacetime/transform.h, for relative γ <= robust_gamma.
struct LaneMotion {
  double celerity[3]{};
  double gamma = 1.0;
  double inverse_gamma_plus_one = 0.5;
  LaneMatrix rotation{};
  bool identity = true;
  bool rotated = false;
};

/// A frame as the camera's event has it: FrameView.
struct LaneFrame {
  LaneMotion from_camera;
  double origin[3]{};  ///< the camera's event...
  double time = 0.0;   ///< ...in the frame's coordinates
};

/// What rays that a mirror passed on have besides: CameraRay's length and offset.
struct RayStarts {
  alignas(64) double length[sheet_size];
  alignas(64) double time[sheet_size];
  alignas(64) double place[3][sheet_size];
};

/// Camera rays from one event; or, of a relay in the place of the camera (relays.h), rays that start nearby.
struct SheetRays {
  int count = 0;
  int padded = 0;  ///< padded_count(count); the last ray is repeated
  bool light_delay = true;
  bool displaced = false;  ///< whether they have starts of their own
  alignas(64) double direction[3][sheet_size];
  RayStarts starts;

  [[nodiscard]] const RayStarts* own_starts() const { return displaced ? &starts : nullptr; }
};

/// A Lens of the perspective projection.
struct LaneLens {
  double foot_x, foot_y, step_x, step_y;  ///< film_of()
  double forward[3], right[3], up[3];
};

/// A ball in a frame.
struct LaneBall {
  double centre[3]{};
  double radius = 0.0;
};

/// n·m >= h for the directions n that may meet something: docs/physics.md equation (15).
struct LaneCone {
  double axis[3]{};  ///< m
  double level = 0;  ///< h, lowered by the bound on its rounding; -infinity: every direction
};

/// Many of them, as arrays with room for a register behind the last. `radius` is that of the sphere behind
/// the cone.
struct ConeTable {
  int count = 0;
  double* axis[3]{};
  double* level = nullptr;
  double* radius = nullptr;
  double* who = nullptr;  ///< an index, exact as a double

  std::array<double**, 6> columns() { return {&axis[0], &axis[1], &axis[2], &level, &radius, &who}; }
};

/// A bundle of directions from one event: a cone around `axis`.
struct Bundle {
  double axis[3]{};
  double cosine = -1.0;  ///< of the half-angle; rounded down
  double sine = 1e-14;
  double time = 0.0;  ///< of a bundle of light: the middle of the emission times, from the camera event's...
  double half_time = 0.0;          ///< ...and how far they are from it
  double reach = __builtin_inf();  ///< the longest way of that light
};

/// Occluders as a light has them, as arrays with room for a register behind the last: each one's motion
/// relative to the light, and where the light is in its frame.
struct LampTable {
  int count = 0;
  bool moving = true;     ///< false: every w is 0
  double* celerity[3]{};  ///< w, of the occluder's frame, in the light's axes
  double* gamma = nullptr;
  double* inverse_gamma_plus_one = nullptr;
  double* speed = nullptr;  ///< |w|
  double* place[3]{};       ///< x₀: the light relative to the occluder's centre, axes turned to the light's
  double* radius = nullptr;
  double* core = nullptr;  ///< of a ball all of which is opaque: it surely shades; <= 0: none
  double* who = nullptr;   ///< an index, exact as a double

  std::array<double**, 12> columns() {
    return {&celerity[0], &celerity[1], &celerity[2], &place[0],
            &place[1],    &place[2],    &gamma,       &inverse_gamma_plus_one,
            &speed,       &radius,      &core,        &who};
  }
  /// A row to where another was.
  void copy(int from, int to) {
    for (double** const column : columns()) (*column)[to] = (*column)[from];
  }
};

/// The light of one lamp on its way to some points, in the lamp's frame.
struct LightRays {
  const double* way[3];      ///< K, from the point to the light
  const double* way_length;  ///< |K|
  const double* time;        ///< of emission, from the camera event's
  double* lit;               ///< 1 or 0
};

/// Points of one frame and material, with what each kernel adds to them.
struct PointSheet {
  int count = 0;
  int padded = 0;
  bool light_delay = true;
  int lane[sheet_size];
  int whole = -1;              ///< the sheet of rays, all of whose hits these are; or -1:
  const double* direction[3];  ///< of the camera ray, camera frame: that sheet's or `gathered`
  const SheetHits* hits;       ///< what they meet: that sheet's or `gathered_hits`
  /// Of rays that a mirror passed on: that sheet's or `gathered_starts`; else null.
  const RayStarts* starts = nullptr;
  alignas(64) double gathered[3][sheet_size];
  SheetHits gathered_hits;
  RayStarts gathered_starts;
  // Neighbours of one surface.
  struct Run {
    int surface;  ///< its number
    int first, last;
  };
  Run runs[sheet_size];
  int run_count = 0;
  /// Whether their matter may not be at rest in their frame: then its celerity there, and γ.
  bool moves = false;
  bool smooth = false;  ///< whether light is reckoned by points.shading_normal
  alignas(64) double celerity[3][sheet_size];
  alignas(64) double gamma[sheet_size];
  RaySheet rays;       ///< the camera's, in their frame
  SheetPoints points;  ///< the normal on the side that is seen, after face()
  int material[sheet_size];
  // face():
  std::uint64_t unresolved;  ///< hits, one bit each
  alignas(64) double to_camera[3][sheet_size];
  alignas(64) double proper_time[sheet_size];
  alignas(64) double doppler[sheet_size];  ///< D on the way to the camera
  /// The number of the surface, if it never shades the side that is seen; or -1. Before face(): if it never
  /// shades its outside.
  alignas(64) double own[sheet_size];
  alignas(64) double own_inside[sheet_size];  ///< the same if it never shades its inside
  // arrive(), for one light:
  alignas(64) double lit[sheet_size];          ///< 1 or 0
  alignas(64) double place[3][sheet_size];     ///< the point in the light's frame, of a distant one
  alignas(64) double way[3][sheet_size];       ///< K, from the point to the light, in the light's frame
  alignas(64) double way_length[sheet_size];   ///< |K|
  RaySheet shadow;                             ///< the same in the points' frame, from off the surface
  alignas(64) double to_light[3][sheet_size];  ///< unit, surface's frame
  alignas(64) double cosine[sheet_size];
  alignas(64) double lamp_doppler[sheet_size];
  alignas(64) double inverse_square[sheet_size];
  alignas(64) double emission_time[sheet_size];           ///< the lamp's own
  alignas(64) double relative_emission_time[sheet_size];  ///< the same from the camera event's
  // reflect():
  alignas(64) double strength[sheet_size];
  alignas(64) double spot_share[sheet_size];  ///< of a spot lamp on a path: Arrival::share
  alignas(64) double irradiance[sheet_size];
  alignas(64) double specular[sheet_size];
  alignas(64) double diffuse[3][sheet_size];  ///< film colour under this lamp
  // Of shifted colours:
  std::uint64_t odd_squares = 0;           ///< of a checker
  alignas(64) double shift[sheet_size];    ///< D from the lamp to the camera
  alignas(64) double lamp[4][sheet_size];  ///< film colour of all of its light, and that's luminance
  alignas(64) double rgb[3][sheet_size];

  [[nodiscard]] LightRays light_rays() {
    return {{way[0], way[1], way[2]}, way_length, relative_emission_time, lit};
  }
};

/// Factors of the searchlight effect, as plain numbers: BrightnessSwitches.
struct LaneBrightness {
  bool photon_energy = true;
  int arrival_rate = 0;  ///< 0 exact, 1 dilation, 2 off
  bool solid_angle = true;
};

/// Where light left a lamp on a path that arrives at some events, for a register of them: illumination.h has
/// it for one.
struct LampMeeting {
  double way[3][8];      ///< from the event to the lamp
  double length[8];      ///< of the way
  double own_length[8];  ///< the same in the frame of the lamp's velocity
  double time[8];        ///< by which its strength goes
  double share[8];       ///< of a spot lamp: Arrival::share; else 1
};

/// A light as seen from the frame of a sheet's points.
struct LaneLamp {
  LaneFrame frame;           ///< the light's
  LaneMotion to_surface;     ///< from the light's frame to the surface's
  double time_offset = 0.0;  ///< of the eye from the camera's event, in the light's frame
  int surface_frame = -1;
  bool own_frame = false;  ///< it rests in the surface's frame
  bool distant = false;
  double position[3]{};
  double direction[3]{};
  /// Of a lamp on a path: called for `count` events, place by place and time by time; else null.
  void (*meet)(const Light&, int count, const double (*place)[8], const double* time, LampMeeting&) = nullptr;
  const Light* light = nullptr;
};

/// What a bundle of light is made from.
struct LightSpan {
  double sum[3]{};
  double least_cosine = 2.0;
  double begin = 1e300;  ///< of the emission times, from the camera event's
  double end = -1e300;
  double reach = 0.0;
};

/// How the points of a sheet reflect the light of one lamp.
struct LaneReflection {
  LaneBrightness brightness;
  bool distant = false;
  double gamma = 1.0;      ///< of the lamp relative to the surface...
  double way[3]{};         ///< ...and its celerity seen from there, for matter that moves
  double specular = 0.0;   ///< k (n+2)/2π; 0: none
  double shininess = 1.0;  ///< n
  bool same_lamp = true;   ///< at all points it has the film colour `lamp`, else PointSheet's
  double lamp[3]{};
  bool shifted = false;        ///< these colours are at the camera's wavelengths
  bool same_strength = false;  ///< at all points: `strength`, else PointSheet's
  double strength = 0.0;
  bool same_diffuse = false;  ///< at all points: `diffuse`, else PointSheet's
  double diffuse[3]{};
  const double* own = nullptr;  ///< the first lamp's light is added to this, else to the points' rgb
};

/// How the light of points goes to the camera.
struct LaneCarriage {
  LaneBrightness brightness;
  double gamma = 1.0;  ///< of the camera relative to their frame...
  double way[3]{};     ///< ...and its celerity seen from there, for matter that moves
  bool shifted = false;
};

/// The kernels of one instruction set.
struct SheetKernels {
  const char* name;
  /// sample_point() of 64 pixels, of several samples each.
  void (*sample)(const SampleRow& row, const int* column, const int* line, double* x, double* y);
  /// The looking directions of a perspective image at the points (x, y): camera/projection.h.
  void (*look)(const LaneLens& lens, const double* x, const double* y, SheetRays& rays);
  /// The smallest bundle about the mean of the rays.
  Bundle (*bundle)(const SheetRays& rays);
  /// Copies the cones that the bundle may meet; `to` has room for all.
  void (*overlapping)(const ConeTable& from, const Bundle& bundle, ConeTable& to);
  /// The same of the occluders on the light's sky.
  void (*overlapping_lamps)(const LampTable& from, const Bundle& bundle, LampTable& to);
  /// Widens the bundle of light that reaches what the rays have hit: with `axis` null only the sums for the
  /// axis, of some of the rays.
  void (*gather)(const LaneLamp& lamp, const SheetRays& rays, const SheetHits& hits, const double* axis,
                 LightSpan& span);
  /// Which of the first `count` numbers are this one, one bit each.
  std::uint64_t (*same)(const double* numbers, int count, double which);
  /// Which rays are in the cone, one bit each; those of their registers in the frame, into `to`.
  std::uint64_t (*enter)(const LaneFrame& frame, const LaneCone& cone, const SheetRays& rays, RaySheet& to);
  /// The same of rays with starts of their own, and a ball that they have to come near.
  std::uint64_t (*enter_near)(const LaneFrame& frame, const LaneBall& ball, const SheetRays& rays,
                              RaySheet& to);
  /// The camera rays of the points in their frame, into points.rays.
  void (*in_frame)(const LaneFrame& frame, PointSheet& points);
  /// What follows from points however found: `to_camera`, proper time, D, and the normal's side.
  void (*face)(PointSheet& points);
  /// The same of rays to the sky: D and texture coordinates.
  void (*face_sky)(PointSheet& points);
  /// What of a lamp's light reaches the points, but for shadows. Bits: the lit ones.
  std::uint64_t (*arrive)(const LaneLamp& lamp, PointSheet& points);
  /// The bundle of the lit rays from `first` to `last` (whole registers); false when there are none.
  bool (*light_bundle)(const LightRays& rays, int first, int last, Bundle& bundle);
  /// Unlights those from `first` to `last` that occluder `which` of the table surely shades: `time` is
  /// amid their emission times. Bits, from the lowest for number 0: those of which that is not clear.
  std::uint64_t (*sift)(const LampTable& occluders, int which, double time, int first, int last,
                        const LightRays& rays);
  /// Which of the lit points may be shaded by their own surface, one bit each.
  std::uint64_t (*turned)(const PointSheet& points);
  /// The light of the lit points among the candidates in an occluder's frame, into `to`. Which they are.
  std::uint64_t (*cast)(const LaneFrame& frame, const LaneMotion& from_light, std::uint64_t candidates,
                        const PointSheet& points, RaySheet& to);
  /// Irradiance and Phong's lobe of the lit points.
  void (*reflect)(const LaneReflection& reflection, PointSheet& points);
  /// rgb += irradiance (diffuse/π + specular lamp) where lit.
  void (*add_light)(const LaneReflection& reflection, PointSheet& points);
  /// Which of the points are on a checker's odd squares, one bit each.
  std::uint64_t (*odd_squares)(double size, const PointSheet& points);
  /// To the camera: rgb *= F, or F D for shifted colours.
  void (*carry)(const LaneCarriage& carriage, PointSheet& points);
};

/// The kernels, if this machine runs them; `baseline` always does.
const SheetKernels& sheet_kernels(InstructionSet set);

}  // namespace backlight
