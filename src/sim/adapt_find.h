#pragma once

#include <array>
#include <string>
#include <vector>

#include "src/sim/adapt_geometry.h"
#include "src/sim/adapt_read.h"
#include "trackbed/sim/adapt.h"

namespace trackbed::adapt {

/// A wheel that was found in the model. The indices refer to the compiled model; the index -1 means
/// that the wheel has no such part.
struct FoundWheel {
  int body = -1;   ///< Body that turns with the wheel.
  int spin = -1;   ///< Hinge joint of the wheel.
  int steer = -1;  ///< Hinge joint with a vertical axis, between the wheel and the vehicle.
  int slide = -1;  ///< Vertical slide joint with a spring, between the wheel and the vehicle.
  RoundGeom round;
  Vector axis = Vector::UnitY();  ///< Axis of the wheel, in world coordinates.
  std::string name;               ///< Quoted name of the wheel's joint or body.
};

/// A vehicle that was found in the model. The vehicle frame V is that of docs/models.md: its origin
/// is on the ground under the rear axle or the driven axle, x points forward.
struct FoundVehicle {
  VehicleKind kind = VehicleKind::kSteered;
  int root = -1;  ///< Child body of the world that contains the vehicle.
  int base = -1;  ///< Deepest body in the tree of bodies that contains all wheels.
  /// Order of the wheels of a car: front left, front right, rear left, rear right. Order of the
  /// driven wheels of a differential drive: left, right.
  std::vector<FoundWheel> wheels;
  Matrix turn = Matrix::Identity();  ///< Rotation matrix; its columns are the axes of the vehicle
                                     ///< frame V in the world.
  Vector origin = Vector::Zero();    ///< Origin of the vehicle frame V in the world [m].
  double radius = 0.0;               ///< Wheel radius [m].
  double width = 0.0;                ///< Width of a tyre [m].
  double wheelbase = 0.0;            ///< [m]
  std::array<double, 2> track{};     ///< Front and rear track [m].

  [[nodiscard]] Vector ToVehicle(const Vector& in_world) const {
    return turn.transpose() * (in_world - origin);
  }
};

/// Collects the guesses and notes that AdaptModel reports.
struct Findings {
  std::vector<AdaptGuess> guesses;
  std::vector<std::string> notes;

  void Guess(std::string what, std::string value, std::string evidence) {
    guesses.push_back({std::move(what), std::move(value), std::move(evidence)});
  }
};

/// Finds the wheels, the axles and the frame of the vehicle. Throws InputError, with a question and
/// the option that answers it, if the model has no vehicle that can be driven.
FoundVehicle FindVehicle(const FoundModel& found, const AdaptOptions& options, Findings& findings);

}  // namespace trackbed::adapt
