// The cone of directions that meet a ball in a frame: docs/physics.md section 8.
#pragma once

#include "backlight/trace/hub.h"
#include "sheet.h"

namespace backlight {

/// Equation (15) for a sphere about `sphere.centre` in the view's frame, seen from `origin` there. Its
/// level is -infinity, all directions, where the eye is inside.
LaneCone cone_of(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere);

/// The same in a frame of large γ, from an eye displaced by `offset`.
LaneCone cone_of(const FarView& far, const BoundingSphere& sphere, const Displacement<Camera>& offset);

/// The same without light delay: rays are straight lines of one moment of the camera's.
LaneCone cone_of_now(const FrameView& view, const Vec3& origin, const BoundingSphere& sphere);

/// Where an eye is in the view's frame, and when.
Event<Rest> eye_event(const FrameView& view, const CameraView& camera, int eye);

}  // namespace backlight
