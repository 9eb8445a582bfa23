#pragma once

#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/control/lqr.h"
#include "trackbed/control/mpc.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/control/playback.h"
#include "trackbed/control/preview_integral.h"
#include "trackbed/control/pure_pursuit.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/control/stanley.h"
#include "trackbed/control/steering_profile.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"
#include "trackbed/vehicle/steering_schedule.h"

/// One interface and one table for everything that steers.
namespace trackbed {

/// What a controller may look at when it is asked, once per control period.
struct ControlInput {
  const VehicleParams& vehicle;
  const Reference& reference;
  const SteeringSchedule& schedule;
  VehicleState state;
  double station = 0.0;    ///< where on the path the car is [m]; see StationSource
  double period = 0.0;     ///< until it is asked again [s]
  double plan_time = 0.0;  ///< since the plan was taken up [s]
  double speed_gain = SpeedControlOptions{}.gain;  ///< for those that set the speed too [1/s]
};

/// Gives the wanted bicycle angle [rad] at the end of the coming period; the vehicle's actuator
/// limits angle and rate. A controller does no input or output, reads no clock, and draws random
/// numbers from a fixed seed alone.
class SteeringController {
 public:
  virtual ~SteeringController() = default;
  virtual double Steer(const ControlInput& input) = 0;

  /// The wanted acceleration [m/s^2] over the coming period, which only the car's own limits cut.
  /// None: the speed is not the controller's business, SpeedControl keeps it.
  virtual std::optional<double> Accelerate(const ControlInput& input);

  /// What it tells of its last answer, for the log: the columns' names, always the same, and one
  /// value for each. None by default.
  [[nodiscard]] virtual std::vector<std::string> Columns() const;
  [[nodiscard]] virtual std::vector<double> Values() const;
};

/// Open loop: the plan's steering schedule at the distance the car will have driven at the end of
/// the period, so that a rate-limited actuator reproduces the schedule whatever the period is.
struct ScheduleOptions {};

/// How the preview controller turns the preview angle u into steering.
enum class PreviewLaw {
  kLinear,    ///< delta = (2 L/R) u: MacAdam's gain for a single point and the kinematic car
  kExactArc,  ///< delta = atan(2 L sin(u)/R): the circle through the point; pure pursuit
};

/// MacAdam's preview (MacAdam 1981) with a single point: the point P of the path at distance R from
/// the rear-axle center O, the first after the nearest one; u is the signed angle from the
/// direction of motion to OP. Beyond its end the path goes on along its tangent. A car further than
/// R from the path heads for the point R ahead of its nearest one.
///
/// The distance trades corners against robustness: a car cuts them by R^2/(8 r), and its wheels
/// turn at a limited rate. Unless `distance` is given, R follows from the car, its speed and the
/// path:
///   R = max(3/4 L,  3 v T,  0.65 S + v T)
///   T [s]  response time: control period + steering lag + m v/(C_f + C_r), the tyres' part 0 for a
///          car without tyre coefficients
///   S [m]  the ramp: how far the car rolls while its wheels turn by more than the path gives them
///          room for, the largest v abs(delta(s_2) - delta(s_1))/omega - (s_2 - s_1) of any two
///          stations s_1 < s_2 within R, with delta = atan(L kappa) of the path
/// with L wheelbase [m], v speed [m/s], omega steering rate [rad/s], C_f, C_r cornering stiffness
/// of the axles [N/rad], m mass [kg]. A car and its path of another size, at the same v/(L omega)
/// and v T/L, are driven with the same relative error. Derivation and sources:
/// docs/algorithms/control.md.
///
/// That distance suits a car on its path. Back to the path from an offset e, it would ask for
/// steering at more than the limited rate, and the car would oscillate about the path. So R is
/// never shorter than 1.5 cbrt(e L v/omega), which is 0 for a car on its path.
struct PreviewOptions {
  std::optional<double> distance;  ///< shortest R [m], > 0; default: the law above
  double time = 0.0;               ///< R is at least time |v| [s]
  PreviewLaw law = PreviewLaw::kExactArc;
  /// With the tyres' slip: u from where the rear axle really moves, and the steering that leads a
  /// car that understeers round the circle. A given distance has to be half a second at 20 m/s,
  /// where 0.3 s swing out for good.
  bool slip = false;
};

/// With the maneuvers of steering_profile.h and recorded inputs, which need no plan.
using ControllerOptions =
    std::variant<ScheduleOptions, PreviewOptions, ConstantSteeringOptions, StepSteeringOptions,
                 RampSteeringOptions, SineSteeringOptions, SineWithDwellOptions, SweptSineOptions,
                 PlaybackOptions, OptimalSteeringOptions, PreviewIntegralOptions,
                 PurePursuitOptions, StanleyOptions, LqrOptions, MpcOptions>;

/// Where a controller takes the station from.
enum class StationSource {
  kProjection,  ///< the nearest point of the path: closes the loop
  kOdometer,    ///< the distance driven: open loop
};

struct ControllerEntry {
  const char* name;
  const char* summary;
  ControllerOptions defaults;
  StationSource station;
  bool needs_plan;
};

/// Every steering controller there is.
const std::vector<ControllerEntry>& Controllers();

/// The entry of the controller that `options` belong to.
const ControllerEntry& ControllerFor(const ControllerOptions& options);

/// Its Steer refuses a state with a number that is none: InternalError.
std::unique_ptr<SteeringController> MakeSteeringController(const ControllerOptions& options);

/// The preview angle u [rad] of a car whose rear axle is at `pose`, looking `distance` [m] ahead
/// along `path` from `station`; positive when the point lies to the left.
double PreviewAngle(const Path& path, const Pose2& pose, double station, double distance);

}  // namespace trackbed
