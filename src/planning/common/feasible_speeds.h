#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/path/acceleration_caps.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/path_pieces.h"
#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/road_hold.h"

/// Speeds at which a car can drive the path of a plan, for MakeFeasible.
namespace trackbed::feasible_speeds {

/// Relative tolerance of a limit.
inline constexpr double kRounding = 1e-6;
/// Distance between checked points along the path [m].
inline constexpr double kCheckSpacing = 0.1;

/// Calls `call` for each stretch of the steering schedule on which the wheels turn, with its start,
/// its end and the slope of the steering angle.
template <typename Call>
void ForEachRamp(const SteeringSchedule& schedule, const Call& call) {
  const std::vector<SteeringSchedule::Knot>& knots = schedule.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double length = knots[i].distance - knots[i - 1].distance;
    const double turned = std::abs(knots[i].steering - knots[i - 1].steering);
    if (turned > 0.0) {
      call(knots[i - 1].distance, knots[i].distance, turned / length);
    }
  }
}

/// Returns the largest lateral acceleration v^2 |kappa| that the road permits at both ends of a
/// piece of the path.
double LateralOver(const RoadHold& road, const Path& path, const Stations& piece);

/// Returns the combined longitudinal and lateral acceleration that a plan requires on a piece of
/// its path, together with the limit. `v_from` and `v_to` are the speeds at both ends of the piece
/// [m/s]. Returns zeros on a flat road where the path is straight or the speed is constant: the
/// separate longitudinal and lateral checks suffice.
RoadHold::Combined CombinedOver(const RoadHold& road, const Path& path, const PathPiece& piece,
                                double v_from, double v_to);

/// Describes the friction factor that the road needs at a place where the pull of gravity exceeds
/// the grip, as a remedy. The grip is proportional to the factor. The factor in the text is a tenth
/// larger, which leaves grip for a slow start and for gentle braking.
std::string FrictionForSlope(const Excess& slope, const Path& path, const PlanRequest& request);

/// Returns whether a leg ends at the station s with an intermediate stop, at which the wheels may
/// turn at standstill.
bool EndsAtStop(const std::vector<Stations>& legs, double s);

/// Returns the parameters of the car for which the steering of a plan is computed. For a plan at
/// the g-g-v limit, the tyres of the returned car slip; for any other plan, its tyres do not slip.
VehicleParams SteeredCar(const Plan& plan, const PlanRequest& request);

/// Returns the steering rate that a plan may use [rad/s]. A plan at the limit may use only a share
/// of the car's steering rate, because the controllers need the rest.
double UsableSteeringRate(const PlanRequest& request);

/// Returns the motion on a piece of a path between the speeds of its ends [m/s]: the larger speed,
/// and the mean acceleration.
PieceSpeed SpeedOn(const Path& path, const PathPiece& piece, const RoadHold& road, double v_from,
                   double v_to);

/// Returns the speed caps that enforce the limits of steering rate, top speed and lateral
/// acceleration, for a car that drives each piece of the path at constant speed. The lateral
/// acceleration gets no cap if the g-g-v diagram determines the plan's speeds.
std::vector<SpeedCap> CapsFor(const Plan& plan, const PlanRequest& request);

/// Returns speed caps for the pieces of the path on which the car must steer faster than
/// UsableSteeringRate at the plan's speeds and accelerations. Each cap is the highest speed at
/// which the car can steer fast enough while it accelerates as planned. The caller repeats the
/// computation, because the speed caps change the accelerations.
std::vector<SpeedCap> CapsForSteering(const Plan& plan, const PlanRequest& request);

/// Returns the speed of the lowest cap, or `speed` if no cap is lower [m/s].
double MinSpeedOf(const std::vector<SpeedCap>& caps, double speed);

/// Returns `limits`, lowered to the smallest acceleration and deceleration of the sections.
SpeedLimits SmallestOf(SpeedLimits limits, const std::vector<AccelerationCap>& sections);

/// Computes the speeds of a plan like SetSpeeds, with the acceleration limits of `sections`.
void SetSpeedsOn(Plan& plan, double start_speed, const SpeedLimits& limits,
                 const std::vector<AccelerationCap>& sections);

/// Sets speeds at the limit of the g-g-v diagram at which the car can steer fast enough while it
/// brakes and accelerates. Adds the required speed caps to `caps`.
std::optional<LimitExcess> SteerableSpeedsAtLimit(Plan& plan, const PlanRequest& request,
                                                  std::vector<SpeedCap>& caps);

/// The shares of the road's grip that a plan may use along the path, > 0; infinite if the plan does
/// not exceed the road's grip.
struct GripShares {
  double driving = std::numeric_limits<double>::infinity();
  double braking = std::numeric_limits<double>::infinity();
};

/// Shares of the grip, about 1/sqrt(2), for braking and accelerating, so that grip is left for
/// bends.
inline constexpr GripShares kBendShares{0.7, 0.7};

/// Returns the largest acceleration and deceleration on each piece of the path (ForEachPiece with
/// kCheckSpacing), the smaller values of both ends of the piece; infinite if they are unknown. The
/// checks of a plan use the same path pieces as its speeds. Wherever the edge of a slippery patch
/// lies, a plan within the limits of the pieces passes the checks.
std::vector<AccelerationCap> GripAlong(const Path& path, const PlanRequest& request);

/// Returns the sections of the path on which the given shares of the road's grip (GripAlong) are
/// less than the limits of the request.
std::vector<AccelerationCap> SectionsOfLessGrip(const Path& path, const PlanRequest& request,
                                                const GripShares& shares);

/// Returns speed caps for each bend in which the plan exceeds the friction ellipse. A bend here is
/// a stretch of the path between two straights. With these speed caps, the car stays within the
/// friction ellipse in the bend, even while it speeds up or slows down. In the capped bends, the
/// acceleration along the path is at most the limit of the request, and at most the share
/// kBendShares of the road's grip.
std::vector<SpeedCap> CapsInBends(const Plan& plan, const PlanRequest& request);

}  // namespace trackbed::feasible_speeds
