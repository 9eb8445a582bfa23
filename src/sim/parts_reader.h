#pragma once

#include <mujoco/mujoco.h>

#include <string>
#include <vector>

#include "src/sim/tyre_reader.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed {

/// Base class of the classes that read a vehicle from its compiled model. PartsReader finds the
/// vehicle's parts by name and collects all errors.
class PartsReader {
 protected:
  /// Tolerance for rounded decimal numbers in a model file: lengths [m], components of axes and
  /// relative sizes [1].
  static constexpr double kExact = 1e-6;
  /// Cosine of the maximum angle between an axis of a wheel and the corresponding axis of the car.
  /// Toe, camber or kingpin inclination tilt the axes of a wheel relative to those of the car.
  static constexpr double kUpright = 0.7;

  PartsReader(const mjModel& model, const std::string& file);

  void AddError(std::string name, std::string message);
  void ThrowIfAnything() const;

  /// Returns the index of the object with the given name. If the model has no such object, Find
  /// adds an error and returns -1.
  int Find(int type, const char* kind, const std::string& name);
  /// Returns the index of the joint with the given name. If the joint does not exist or has another
  /// type, adds an error and returns -1.
  int Joint(const std::string& name, int type, const char* kind);
  /// Returns the first number of a <numeric> element under <custom>. If the <numeric> element is
  /// missing, adds an error and returns 0.
  double Number(const std::string& name);

  [[nodiscard]] std::string QuotedName(int type, int id) const;
  /// Returns one coordinate of a world point relative to the origin of the chassis, in the
  /// configuration qpos0 [m].
  [[nodiscard]] double Offset(const mjtNum* point, std::size_t axis) const;
  /// Returns one coordinate of a body's origin relative to the origin of the chassis, in the
  /// configuration qpos0 [m].
  [[nodiscard]] double Place(int body, std::size_t axis) const;
  [[nodiscard]] static std::string Text(const mjtNum* v);

  /// Reads the address of the chassis in the state vector, and the mass, inertia and center of
  /// gravity of all bodies that move with the free joint.
  void ReadChassis(int free_joint);
  /// Checks that the origin of the chassis lies below the middle of the wheels of `axle`. `wheels`
  /// is the name of the two wheels in error messages.
  void CheckOrigin(const char* axle, const char* wheels, int left, int right);
  /// Checks the axis and the tyre geom of the wheel whose joint is spin_`wheel`. If the tyre's size
  /// differs from that of the geom `first`, adds the error "`all` must be equal".
  void CheckWheel(const std::string& wheel, int spin, int tyre, int first, const char* all);
  /// Checks that in the configuration qpos0 the wheel touches the model's own ground, with a
  /// tolerance of half the wheel's radius. CheckStand does not check the wheel if the model's
  /// ground is not level.
  void CheckStand(const std::string& wheel, const mjtNum* hub_W, double radius);
  void ReadFootprint(int site);
  void ReadAerodynamics();

  const mjModel& m_;
  std::string file_;
  MujocoData data_;  // MuJoCo's data of the model in the configuration qpos0
  std::vector<Problem> problems_;
  Numerics numerics_{
      m_, [this](const std::string& name, const std::string& message) { AddError(name, message); }};
  ChassisParts chassis_;
  VehicleParams params_;
};

}  // namespace trackbed
