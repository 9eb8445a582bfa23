#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "src/control/error_model.h"
#include "src/control/obstacle_cells.h"
#include "src/control/tracking.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/control/surroundings.h"

namespace trackbed {

/// Settings of the roll-outs of MPPI; options without a value have been replaced by their defaults.
struct RollOutSettings {
  int steps = 50;          ///< Number of steps of a roll-out, >= 1.
  double step = 0.02;      ///< Duration of a step [s], > 0.
  ErrorWeights weights{};  ///< Cost weights of the deviation from the path.
  double margin = 0.0;     ///< Clearance below which an obstacle adds cost [m], >= 0.
  double grip = 1.0;       ///< Fraction of the lateral grip that may be used without cost.
};

/// State of the car in a roll-out. Positions are in the frame A, the path's pose at the station of
/// the car at the beginning of the roll-out.
struct RolledCar {
  double x = 0.0;  ///< Position of the rear axle [m].
  double y = 0.0;
  double yaw = 0.0;                   ///< Heading [rad].
  double lateral_speed = 0.0;         ///< Lateral speed of the center of gravity [m/s].
  double yaw_rate = 0.0;              ///< Yaw rate [rad/s].
  double lateral_acceleration = 0.0;  ///< Lateral acceleration in the last step [m/s^2].
  double actuator = 0.0;              ///< Steering angle of the actuator [rad].
  double wheels = 0.0;                ///< Steering angle of the wheels [rad].
  double station = 0.0;               ///< Station minus the car's station at the start [m].
  double cross_track = 0.0;           ///< Offset e from the path [m].
  double heading_error = 0.0;         ///< Heading error psi relative to the path [rad].
};

/// Simulates a car along a path, and sums up the cost of its motion. The symbols of the cost are
/// those of MppiOptions.
class RollOuts {
 public:
  /// Prepares the roll-outs of a control period. The argument `tracking` is the deviation of the
  /// car from its path, and `actuator` is the steering angle from which the commands start [rad].
  /// The pointer `surroundings` may be null.
  void Prepare(const ControlInput& input, const Tracking& tracking, double actuator,
               const Surroundings* surroundings, const RollOutSettings& settings);

  /// Returns the cost of a roll-out. `rate_of(k, car)` is the wanted steering rate [rad/s] in the
  /// step k, counted from 0. The function Cost clamps the wanted rate to the car's largest steering
  /// rate.
  template <typename RateOf>
  [[nodiscard]] double Cost(const RateOf& rate_of) const {
    RolledCar car = start_;
    double cost = 0.0;
    for (int k = 0; k < settings_.steps; ++k) {
      const double rate = std::clamp(rate_of(k, car), -rate_limit_, rate_limit_);
      Advance(k, rate, car);
      cost += weights_.steering_rate * rate * rate + StageCost(k, car);
    }
    return cost + RemainingCost(car);
  }

  /// Returns the steering rate that the controller lqr would command for the car [rad/s].
  [[nodiscard]] double RegulatorRate(const RolledCar& car) const;
  /// Returns the steering rate [rad/s] that the controller lqr commands at the start of the
  /// roll-outs, within the rate limit.
  [[nodiscard]] double StartRate() const {
    return std::clamp(RegulatorRate(start_), -rate_limit_, rate_limit_);
  }
  /// Returns the largest steering rate [rad/s].
  [[nodiscard]] double rate_limit() const { return rate_limit_; }

 private:
  /// A sampled point (node) of the path, with the car's steady turn at this point.
  struct Node {
    double x = 0.0;
    double y = 0.0;
    double yaw = 0.0;
    double cosine = 1.0;  // Cosine of the direction of motion.
    double sine = 0.0;
    double curvature = 0.0;  // Mean path curvature to the next node, in the direction of motion.
    SteadyTurn steady{};
    EdgeDistances edges{};
  };
  /// Values of a time step that are the same for all roll-outs.
  struct Stage {
    double speed = 0.0;                      // Signed speed of the car at the step's end [m/s].
    double station = 0.0;                    // Planned station at the end of the step [m].
    std::array<double, 2> stiffness{};       // Cornering stiffness of the axles [N/rad].
    std::array<double, 2> friction_force{};  // Largest lateral force of the axles [N].
  };

  void PrepareStages(const ControlInput& input);
  void PrepareNodes(const ControlInput& input, const Tracking& tracking,
                    const Surroundings* surroundings);
  void PrepareRegulator(const ControlInput& input, const Tracking& tracking);
  void PrepareObstacles(const Tracking& tracking, const Surroundings* surroundings);
  [[nodiscard]] Stage StageAt(double speed, double acceleration) const;

  void Advance(int k, double rate, RolledCar& car) const;
  void Slide(const Stage& stage, double speed, RolledCar& car) const;
  void Project(RolledCar& car) const;
  /// Returns the position of a station among the path nodes, as a fractional node index.
  [[nodiscard]] double PlaceOf(double station) const;
  [[nodiscard]] SteadyTurn SteadyAt(double station) const;
  /// Returns the deviation z of the car's state from the steady turn on the path.
  [[nodiscard]] ErrorModel::Vector DeviationOf(const RolledCar& car) const;
  [[nodiscard]] double StageCost(int k, const RolledCar& car) const;
  /// Returns the cost of small distances from obstacles and road edges.
  [[nodiscard]] double ClosenessCost(int k, const RolledCar& car) const;
  [[nodiscard]] double GapToEdges(const RolledCar& car) const;
  [[nodiscard]] double RemainingCost(const RolledCar& car) const;

  static constexpr int kNodes = 128;

  RollOutSettings settings_;
  VehicleParams vehicle_;
  ErrorWeights weights_;
  Regulator regulator_;
  double largest_offset_ = 0.0;  // Offset beyond which the terminal cost grows linearly [m].
  int direction_ = 1;
  bool slips_ = false;  // Whether the car has tyre coefficients.
  bool has_edges_ = false;
  double rate_limit_ = 0.0;
  double lag_decay_ = 0.0;  // Factor by which the wheel angle's error decays in a step.
  double lag_ = 0.0;        // Time constant of the wheels' lag [s].
  double grip_ = 0.0;       // Lateral acceleration up to which no cost is added [m/s^2].
  double first_ = 0.0;      // Station of the first node [m].
  double spacing_ = 1.0;    // Distance between nodes [m].
  std::vector<Node> nodes_;
  std::vector<Stage> stages_;
  ObstacleCells obstacles_;
  RolledCar start_;
};

}  // namespace trackbed
