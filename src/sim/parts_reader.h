#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "src/sim/tyre_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed {

/// Base of the vehicle readers. PartsReader finds parts by name in a compiled model and collects
/// all errors.
class PartsReader {
 protected:
  /// Tolerance for decimal fractions in a file [m], and for axes and relative sizes [1].
  static constexpr double kExact = 1e-6;
  /// Cosine of the largest angle between a wheel's axes and the car's axes, due to toe, camber or
  /// kingpin.
  static constexpr double kUpright = 0.7;

  PartsReader(const mjModel& model, const std::string& file);

  void AddError(std::string name, std::string message);
  void ThrowIfAnything() const;

  /// Index of the named object. Find() adds an error and returns -1 if the object is missing.
  int Find(int type, const char* kind, const std::string& name);
  /// Index of the named joint. Joint() adds an error and returns -1 if the joint is missing or of
  /// another type.
  int Joint(const std::string& name, int type, const char* kind);
  /// The first number of a <custom><numeric>. Number() adds an error and returns 0 if the numeric
  /// is missing.
  double Number(const std::string& name);

  [[nodiscard]] std::string QuotedName(int type, int id) const;
  /// Coordinate of a point of the world relative to the chassis' origin, at qpos0 [m].
  [[nodiscard]] double Offset(const mjtNum* point, std::size_t axis) const;
  /// Coordinate of a body's origin relative to the chassis' origin, at qpos0 [m].
  [[nodiscard]] double Place(int body, std::size_t axis) const;
  [[nodiscard]] static std::string Text(const mjtNum* v);

  /// Reads state address, mass, inertia and center of gravity of the bodies below the free joint.
  void ReadChassis(int free_joint);
  /// Checks that the chassis' origin lies under the two wheels of `axle`. Messages call the two
  /// wheels `wheels`.
  void CheckOrigin(const char* axle, const char* wheels, int left, int right);
  /// Checks axis and tyre of the wheel with the joint spin_`wheel`. The tyre must be as large as
  /// the geom `first`. If the tyre has another size, the message is "`all` must be equal".
  void CheckWheel(const std::string& wheel, int spin, int tyre, int first, const char* all);
  /// Checks that at qpos0 the wheel touches the model's own ground, within half its radius.
  /// CheckStand ignores ground that is not level.
  void CheckStand(const std::string& wheel, const mjtNum* hub_W, double radius);
  void ReadFootprint(int site);
  void ReadAerodynamics();

  const mjModel& m_;
  std::string file_;
  MujocoData data_;  // positions of the model at qpos0
  std::vector<Problem> problems_;
  Numerics numerics_{
      m_, [this](const std::string& name, const std::string& message) { AddError(name, message); }};
  ChassisParts chassis_;
  VehicleParams params_;
};

}  // namespace trackbed
