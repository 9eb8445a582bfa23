#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "src/sim/tyre_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed {

/// What readers of vehicles have in common: they find parts by name in a compiled model, and gather
/// all that is wrong with them.
class PartsReader {
 protected:
  /// What decimal fractions in a file may be off by [m], and axes and relative sizes [1].
  static constexpr double kExact = 1e-6;
  /// Cosine of the most that a wheel's axes may lean away from the car's: toe, camber, kingpin.
  static constexpr double kUpright = 0.7;

  PartsReader(const mjModel& model, const std::string& file);

  void AddError(std::string name, std::string message);
  void ThrowIfAnything() const;

  /// Its index; -1 after an error when it is missing.
  int Find(int type, const char* kind, const std::string& name);
  /// Likewise, also when it is of another type.
  int Joint(const std::string& name, int type, const char* kind);
  /// The first number of a <custom><numeric>, or 0 after an error.
  double Number(const std::string& name);

  [[nodiscard]] std::string QuotedName(int type, int id) const;
  /// Of a point of the world, in the vehicle's frame.
  [[nodiscard]] double Offset(const mjtNum* point, std::size_t axis) const;
  /// Of a body's origin, likewise.
  [[nodiscard]] double Place(int body, std::size_t axis) const;
  [[nodiscard]] static std::string Text(const mjtNum* v);

  /// Place in the state, mass, inertia and center of gravity of what hangs on the free joint.
  void ReadChassis(int free_joint);
  /// That the chassis' origin lies under the two wheels of `axle`, whom messages call `wheels`.
  void CheckOrigin(const char* axle, const char* wheels, int left, int right);
  /// Axis and tyre of the wheel whose joint is spin_`wheel`; its tyre must be as large as the geom
  /// `first`, "`all` must be equal".
  void CheckWheel(const std::string& wheel, int spin, int tyre, int first, const char* all);
  /// That the wheel is on the car's own ground, if that is level, at qpos0, to half its radius.
  void CheckStand(const std::string& wheel, const mjtNum* hub_W, double radius);
  void ReadFootprint(int site);
  void ReadAerodynamics();

  const mjModel& m_;
  std::string file_;
  MujocoData data_;  // positions at qpos0
  std::vector<Problem> problems_;
  Numerics numerics_{
      m_, [this](const std::string& name, const std::string& message) { AddError(name, message); }};
  ChassisParts chassis_;
  VehicleParams params_;
};

}  // namespace trackbed
