#include "src/control/actuator_model.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "src/control/preview_distance.h"
#include "src/control/steering_limit.h"
#include "src/control/tracking.h"
#include "trackbed/control/surroundings.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/single_track_car.h"
#include "trackbed/vehicle/steering_actuator.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/vehicle/steering_response.h"

// Compensates the delay of the steering actuator for every control law:
//   1. Predict the car's state at the end of the dead time, from the commands that have not taken
//      effect yet.
//   2. Call the control law with the predicted state.
//   3. Convert the wanted wheel angle to a command, by a dead zone, half of the backlash, a lead
//      filter and the inverse calibration curve.
namespace trackbed {
namespace {

/// Largest half-width of the dead zone around the steady turn, as a fraction of half the backlash.
constexpr double kDeadZone = 0.5;

/// Largest offset from the path due to the dead zone, as a fraction of the wheelbase L. A control
/// law that steers to a preview point at the distance R leaves an offset of up to R^2/(2 L) times
/// the half-width of the dead zone. The distance R grows with the speed, so the offset from the
/// path grows with the square of the speed.
constexpr double kDeadOffset = 0.04;

/// Reversal of the wanted angle below which the actuator stays at rest, as a fraction of the
/// half-width of the dead zone. The end of a correction is no such reversal.
constexpr double kReversal = 0.25;

/// The backlash is considered crossed if the actuator's remaining angle to its target is at most
/// kPassed times half the backlash.
constexpr double kPassed = 0.125;

/// Factor by which the lead shortens the lag of the actuator and amplifies the noise of the wanted
/// angle.
constexpr double kLead = 3.0;

/// Largest amplification of a steering step that crosses the backlash. If possible, the amplified
/// step crosses the backlash within a control period. Without amplification, a steering step that
/// barely exceeds the backlash would take many times the actuator's lag.
constexpr double kCrossingLead = 6.0;

/// Number of timesteps of the modeled actuator in a control period. With a single timestep per
/// control period, the lag of the model would differ from the lag of the actuator. Feedback of the
/// difference between modeled and real lag would move the command back and forth through the
/// backlash.
constexpr int kSubsteps = 10;

/// Distance ahead in which the control law may plan the steering of the path, in multiples of the
/// distance that the car drives while its wheels turn from straight ahead to their limit. The ramp
/// and the tail of RampedPath begin up to 2.5 such distances ahead of a step of curvature.
constexpr double kSwingsAhead = 2.5;

constexpr double kSameTime = 1e-9;  // [s]

/// Returns the command for which the calibration curve has the value `angle` [rad], by bisection.
double CommandFor(const MonotoneCurve& curve, const std::vector<Vec2>& points, double angle) {
  double low = points.front().x();
  double high = points.back().x();
  constexpr int kHalvings = 50;  // halves the interval down to the rounding error
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (curve.At(middle) < angle ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Returns the half-width of the dead zone around the steady turn [rad].
double DeadZone(const VehicleParams& vehicle, double speed, double period) {
  const double preview = ShortestPreview(vehicle, speed, period);
  const double harmless =
      2.0 * kDeadOffset * vehicle.wheelbase * vehicle.wheelbase / (preview * preview);
  return std::min(kDeadZone * 0.5 * vehicle.steering_response.backlash, harmless);
}

/// Returns the steering response without its calibration curve, because the filter receives angles
/// to which the curve has already been applied.
SteeringResponse WithoutCurve(SteeringResponse response) {
  response.curve.clear();
  return response;
}

/// Model of the steering actuator, with the parameters that the controller knows.
class ActuatorModel {
 public:
  ActuatorModel(const VehicleParams& vehicle, double period, double angle)
      : limits_{vehicle.steering_limit, vehicle.steering_rate},
        response_(vehicle.steering_response),
        filter_(WithoutCurve(response_), period / kSubsteps, angle),
        step_(period / kSubsteps),
        half_(0.5 * response_.backlash),
        highest_(limits_.angle + half_),
        lowest_(-highest_),
        wanted_(angle),
        target_(angle),
        resting_(angle),
        lagged_(angle),
        angle_(angle) {
    if (!response_.curve.empty()) {
      curve_.emplace(response_.curve);
      lowest_ = response_.curve.front().y();
      highest_ = response_.curve.back().y();
    }
    if (response_.time_constant > 0.0) {
      const double decay = period / response_.time_constant;
      moved_ = -std::expm1(-decay);
      lead_ = std::expm1(-kLead * decay) / std::expm1(-decay);
      crossing_lead_ = std::clamp(1.0 / moved_, lead_, kCrossingLead);
    }
  }

  /// Returns the angle of the actuator at the beginning of the present control period [rad].
  [[nodiscard]] double angle() const { return angle_; }
  /// Returns the last steering angle that the control law wanted [rad].
  [[nodiscard]] double wanted() const { return wanted_; }
  [[nodiscard]] const SteeringFilter& filter() const { return filter_; }
  /// Returns the last output of the calibration curve, to which the backlash is applied [rad].
  [[nodiscard]] double target() const { return target_; }

  /// Advances the actuator model by a control period and returns the command that brings the
  /// actuator to rest at `wanted` [rad]. The argument `steady` is the steering angle of the steady
  /// turn on the path. The argument `zone` is the half-width of the dead zone around `steady`
  /// [rad].
  double Command(double wanted, double steady, double zone) {
    wanted_ = std::clamp(wanted, -limits_.angle, limits_.angle);
    const double rest = wanted_ - std::clamp(wanted_ - steady, -zone, zone);
    const double turn = rest - resting_;
    // A correction that outlasts its error feeds a limit cycle from edge to edge of the dead zone.
    const bool ends = corrects_ && rest == steady;
    if (turn != 0.0 && (turn * play_ >= 0.0 || ends || std::abs(turn) >= kReversal * zone)) {
      crosses_ = crosses_ || turn * play_ < 0.0;
      play_ = std::copysign(half_, turn);
      resting_ = rest;
      corrects_ = rest != steady;
    }
    const double left = resting_ + play_ - lagged_;
    crosses_ = crosses_ && std::abs(left) > kPassed * half_;
    target_ = std::clamp(lagged_ + (crosses_ ? crossing_lead_ : lead_) * left, lowest_, highest_);
    lagged_ += moved_ * (target_ - lagged_);
    for (int i = 0; i < kSubsteps; ++i) {
      angle_ = MoveSteering(limits_, angle_, filter_.Pass(target_)).At(step_);
    }
    return curve_ ? CommandFor(*curve_, response_.curve, target_) : target_;
  }

 private:
  SteeringLimits limits_;
  SteeringResponse response_;
  std::optional<MonotoneCurve> curve_;
  SteeringFilter filter_;
  double step_;     // Timestep of the filter [s].
  double half_;     // Half of the backlash [rad].
  double highest_;  // Limits of the steering angle before lag and backlash.
  double lowest_;
  double moved_ = 1.0;          // Fraction of a step completed after lagging for a period.
  double crossing_lead_ = 1.0;  // Amplification of a command step across the backlash.
  bool crosses_ = false;        // Whether the actuator crosses the backlash after a reversal.
  double lead_ = 1.0;           // Amplification of a command step without backlash crossing.
  double wanted_;               // Last steering angle that the control law wanted.
  double target_;               // Output of the calibration curve, before backlash.
  double resting_;              // Angle at which the actuator comes to rest after the last command.
  bool corrects_ = false;       // Whether `resting_` differs from the steady turn by a correction.
  double play_ = 0.0;           // Half of the backlash on the side to which the actuator turns.
  double lagged_;  // Angle after the lag and before backlash, at the end of the dead time.
  double angle_;
};

/// Drives the kinematic car or the linear single-track car from a measured state.
class PredictedCar {
 public:
  PredictedCar(const VehicleParams& vehicle, const VehicleState& state)
      : gear_(state.speed < 0.0 ? -1 : 1) {
    const KinematicState start{.pose = state.pose,
                               .speed = state.speed,
                               .steering = state.steering,
                               .distance = state.distance};
    if (HasTyres(vehicle) && std::abs(state.speed) >= kMinDynamicSpeed) {
      single_track_.emplace(vehicle, SingleTrackState{.pose = state.pose,
                                                      .speed = state.speed,
                                                      .lateral_speed = state.lateral_speed,
                                                      .yaw_rate = state.yaw_rate,
                                                      .steering = state.steering,
                                                      .distance = state.distance});
    } else {
      kinematic_.emplace(vehicle, ReferencePoint::kRearAxle, start);
    }
  }

  void Step(double steering, double duration) {
    const trackbed::Command command{.steering = steering, .gear = gear_};
    single_track_ ? single_track_->Step(command, duration) : kinematic_->Step(command, duration);
  }

  [[nodiscard]] VehicleState FullState() const {
    return single_track_ ? single_track_->FullState() : kinematic_->FullState();
  }

 private:
  int gear_;
  std::optional<KinematicCar> kinematic_;
  std::optional<SingleTrackCar> single_track_;
};

class ActuatorCompensation final : public SteeringController, public SeesSurroundings {
 public:
  ActuatorCompensation(std::unique_ptr<SteeringController> inner, ActuatorKnowledge knowledge)
      : inner_(std::move(inner)), knowledge_(knowledge) {}

  double Steer(const ControlInput& input) override {
    const double road = std::exchange(road_, 1.0);
    slips_ = slips_ || RearAxleSlips(input);
    vehicle_ = input.vehicle;
    vehicle_.friction_longitudinal *= road;
    vehicle_.friction_lateral *= road;
    if (!slips_) {
      vehicle_.cornering_stiffness_front = 0.0;
      vehicle_.cornering_stiffness_rear = 0.0;
    }
    if (input.vehicle.steering_response.ideal() && knowledge_ == ActuatorKnowledge::kModel) {
      return SteerWithin(input, input.state);
    }
    if (knowledge_ == ActuatorKnowledge::kIgnore) {
      vehicle_.steering_response = {};
      vehicle_.steering_lag = 0.0;
      return SteerWithin(input, input.state);
    }
    if (!model_) {
      model_.emplace(input.vehicle, input.period, input.state.steering_actuator);
    }
    UpdateError(input);
    const VehicleState state = Predict(input);
    vehicle_.steering_response = {};
    vehicle_.steering_response.time_constant =
        input.vehicle.steering_response.time_constant / kLead;
    const ControlInput ahead = Ahead(input, state);
    const PathBend bend = ahead.reference.path.BendAt(ahead.station);
    const double steady =
        SteadyTurnOn(vehicle_, bend.curvature, bend.direction * std::abs(ahead.state.speed))
            .steering;
    return model_->Command(SteerWithin(input, state), steady,
                           DeadZone(input.vehicle, input.state.speed, input.period));
  }

  std::optional<double> Accelerate(const ControlInput& input) override {
    return inner_->Accelerate(input);
  }
  void See(const Surroundings& surroundings) override {
    road_ = surroundings.RoadFriction();
    if (auto* const sees = dynamic_cast<SeesSurroundings*>(inner_.get())) {
      sees->See(surroundings);
    }
  }
  [[nodiscard]] std::vector<std::string> Columns() const override { return inner_->Columns(); }
  [[nodiscard]] std::vector<double> Values() const override { return inner_->Values(); }
  [[nodiscard]] std::unique_ptr<SteeringController> Clone() const override {
    std::unique_ptr<SteeringController> inner = inner_->Clone();
    if (!inner) {
      return nullptr;
    }
    auto copy = std::make_unique<ActuatorCompensation>(std::move(inner), knowledge_);
    copy->model_ = model_;
    copy->error_ = error_;
    copy->slips_ = slips_;
    return copy;
  }

 private:
  /// Returns the steering angle that the control law wants in the predicted `state` of the car,
  /// clamped to AllowedSteering.
  double SteerWithin(const ControlInput& input, const VehicleState& state) {
    ControlInput ahead = Ahead(input, state);
    const double curvature = input.reference.path.BendAt(ahead.station).curvature;
    SteeringRange range = AllowedSteering(vehicle_, state, curvature);
    if (knowledge_ == ActuatorKnowledge::kModel) {
      range.lowest = std::max(range.lowest, -SteeringReach(input.vehicle, -1.0));
      range.highest = std::min(range.highest, SteeringReach(input.vehicle, 1.0));
    }
    const double reach = vehicle_.steering_limit;
    const double swing = std::abs(state.speed) * reach / vehicle_.steering_rate;
    vehicle_.steering_limit =
        std::max({-range.lowest, range.highest,
                  std::min(reach, SteeringAhead(ahead, kSwingsAhead * swing))});
    return std::clamp(inner_->Steer(ahead), range.lowest, range.highest);
  }

  /// Returns the inputs of the controller for the predicted `state` of the car.
  [[nodiscard]] ControlInput Ahead(const ControlInput& input, const VehicleState& state) const {
    const double moved = state.distance - input.state.distance;
    const double speed = std::abs(input.state.speed);
    return {.vehicle = vehicle_,
            .reference = input.reference,
            .schedule = input.schedule,
            .state = state,
            .station = StationOf(input, state, moved),
            .period = input.period,
            .plan_time = input.plan_time + (speed > 0.0 ? moved / speed : 0.0),
            .speed_gain = input.speed_gain};
  }

  /// Returns the station of the predicted state. The predicted station differs from the car's
  /// station by at most the moved distance plus a quarter of the wheelbase.
  static double StationOf(const ControlInput& input, const VehicleState& state, double moved) {
    if (moved == 0.0) {
      return input.station;
    }
    const double margin = moved + 0.25 * input.vehicle.wheelbase;
    return input.reference.path
        .Project(state.pose, {input.station - margin, input.station + margin})
        .s;
  }

  /// Passes the error of the modeled actuator angle through a low-pass filter with the dead time as
  /// its time constant. Without the filter, an error of the modeled delay by a single control
  /// period makes the command saw.
  void UpdateError(const ControlInput& input) {
    const double error = input.state.steering_actuator - model_->angle();
    const double dead_time = input.vehicle.steering_response.dead_time;
    const double share = dead_time > 0.0 ? -std::expm1(-input.period / dead_time) : 1.0;
    error_ += share * (error - error_);
  }

  /// Returns the car's state at the end of the dead time.
  [[nodiscard]] VehicleState Predict(const ControlInput& input) const {
    PredictedCar car(vehicle_, input.state);
    SteeringFilter filter = model_->filter();
    const double step = input.period / kSubsteps;
    for (double left = input.vehicle.steering_response.dead_time; left > kSameTime; left -= step) {
      car.Step(filter.Pass(model_->target()) + error_, std::min(left, step));
    }
    VehicleState ahead = car.FullState();
    ahead.time = input.state.time;
    ahead.steering_actuator = model_->wanted() + error_;
    ahead.wheels = input.state.wheels;
    ahead.roll = input.state.roll;
    ahead.pitch = input.state.pitch;
    return ahead;
  }

  std::unique_ptr<SteeringController> inner_;
  ActuatorKnowledge knowledge_;
  std::optional<ActuatorModel> model_;
  double error_ = 0.0;     // Filtered measured minus modeled angle of the actuator [rad].
  VehicleParams vehicle_;  // The car that the wrapped controller receives; reuses its heap memory.
  bool slips_ = false;     // Whether the rear axle has ever moved sideways.
  double road_ = 1.0;  // Factor by which the road scales the tyres' friction in the coming period.
};

}  // namespace

std::unique_ptr<SteeringController> WithActuatorModel(std::unique_ptr<SteeringController> inner,
                                                      ActuatorKnowledge knowledge) {
  return std::make_unique<ActuatorCompensation>(std::move(inner), knowledge);
}

}  // namespace trackbed
