// The same scene told from another inertial frame.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "backlight/base/vector.h"

namespace backlight::test {

using Vec4 = std::array<double, 4>;  ///< (t, x, y, z)

/// A frame by its celerity in the world and the world event of its origin.
struct FrameModel {
  std::string name;
  Vec3 celerity{0.0};
  Vec4 origin{};
  std::string within;  ///< the frame in whose coordinates both are; empty: the world
};

/// Something at rest in a frame: what is turned by a change of description is kept apart from the rest.
struct ObjectModel {
  std::string frame;
  std::string body;  ///< further keys of the table
  Vec3 position{0.0};
  Vec3 rotate{0.0};  ///< degrees about x, then y, then z
};

struct LightModel {
  std::string frame;
  std::string body;
  Vec3 position{0.0};
};

struct CameraModel {
  std::string frame;
  Vec3 position{0.0};
  Vec3 direction{0.0, 0.0, 1.0};
  Vec3 up{0.0, 1.0, 0.0};
  double time = 0.0;
};

/// A scene with all that a Lorentz transformation touches as numbers. c = 1.
struct SceneModel {
  std::string film;
  std::string extra;  ///< further tables, taken over as they are
  std::vector<FrameModel> frames;
  CameraModel camera;
  std::vector<ObjectModel> objects;
  std::vector<LightModel> lights;
};

/// An empty scene of frames that pass one another, "ground", "fair" and "lamp", seen from a fourth, "eye".
SceneModel passing_frames(const std::string& film);

std::string to_toml(const SceneModel& model);

struct Redescription {
  SceneModel model;
  std::vector<Mat3> rotation_of_object;  ///< the Wigner rotation of each object's frame
};

/// The scene in the coordinates of the frame that moves with `celerity` in the old world: docs/physics.md
/// section 1. Frame F's new axes are the pure boost of the new world's, so everything in it turns by
/// R = B(u') B(U) B(u)⁻¹.
Redescription redescribed(const SceneModel& model, const Vec3& celerity);

/// The scene as it stands within a frame that moves with `celerity`: no number of it but for the turned axes
/// changes, so that the celerity may be any.
Redescription within_frame(const SceneModel& model, const Vec3& celerity);

}  // namespace backlight::test
