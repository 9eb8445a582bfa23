#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/avoidance/turn_manoeuvre.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"

/// The local planner (Skackauskas, dissertation, listing F.2): leads a plan around obstacles that
/// stand in its way. RRT* finds on which side to pass, a Bezier curve of degree 7 leads past, and a
/// search moves its control points until it can be driven safely.
///
/// Symbols: SD safe distance, from the car's outline to an obstacle [m]; t_d system delay [s];
/// S = r + v t_d the distance before and after a turn of radius r within which the car leaves its
/// path and is back on it [m].
namespace trackbed {

/// "inner" or "outer".
const char* ToString(Ring ring);

enum class RingChoice {
  kAuto,   ///< that of the RRT* path; the other one if it cannot be had
  kInner,  ///< this one alone
  kOuter,
};

struct BezierAvoidanceOptions {
  double safe_distance = 1.5;           ///< SD [m], >= 0
  double delay = 0.9;                   ///< t_d [s], >= 0: until then the old plan is driven
  RingChoice ring = RingChoice::kAuto;  ///< on a straight, inner means left
  double min_speed = 0.5;               ///< the car is not made slower than this to get past [m/s]
  double max_lateral_acceleration = 3.0;  ///< of the curve [m/s^2]
  double steering_rate_share = 0.9;       ///< of the car's steering rate that the curve may ask for
  double comfortable_rate_share = 0.5;    ///< curves that ask for no more are preferred
  int rrt_iterations = 2000;
  double rrt_step = 5.0;  ///< [m]
  /// Of the control points; one curve may take a few such searches.
  SearchOptions search{.method = SearchMethod::kSlsqp, .evaluations = 2000, .tolerance = 1e-6};
};
void Visit(KeyVisitor& keys, BezierAvoidanceOptions& options);

/// The options of one way to avoid obstacles.
using AvoiderOptions = std::variant<BezierAvoidanceOptions>;

struct AvoiderEntry {
  const char* name;
  const char* summary;
  AvoiderOptions defaults;
};

/// Every local planner there is.
const std::vector<AvoiderEntry>& Avoiders();

/// What the local planner is told.
struct AvoidanceRequest {
  VehicleParams vehicle;
  Plan plan;                           ///< that is being driven
  SpeedLimits speed;                   ///< of the mission
  std::vector<OrientedBox> obstacles;  ///< known so far
  double station = 0.0;                ///< the plan cannot be left before here [m]
  double station_speed = 0.0;          ///< of the car there [m/s]
  /// The car as it is at `station`. The new plan then starts there, and its stations with it: from
  /// the car itself if the obstacle is near, else along the old plan.
  struct Car {
    Pose2 pose;             ///< rear axle
    double steering = 0.0;  ///< actual bicycle angle [rad]
  };
  std::optional<Car> car;
  std::uint64_t seed = 0;
};

/// Whether the rest of a plan, from `station` on, comes closer than `distance` to an obstacle.
bool IsInTheWay(const VehicleParams& vehicle, const Path& path, double station,
                const OrientedBox& obstacle, double distance);

/// The plan that avoids the obstacles. What it passes is told in its diagnostics under "avoid", one
/// entry for each stretch that was replaced; a plan that nothing stands in the way of comes back as
/// it was. Where neither side can be passed even at `min_speed`, the plan ends before the obstacle
/// and says why (Plan::blocked).
///
/// Guarantees: every replaced stretch keeps the outline at least SD from every known obstacle
/// (sampled every 0.05 m), the steering within the car's limit, its rate at the planned speed
/// within the given share, and joins the rest with continuous position, heading and curvature: at
/// its start those of the plan, or the car's pose and actual steering. Without a car, the plan up
/// to where it is left is unchanged. Does not look at obstacles beyond SD from the plan, nor move
/// them. Errors: InternalError for options out of range. Cost: 0.1 to 0.3 s a stretch, some
/// seconds where nothing can be found.
Plan PlanAround(const AvoidanceRequest& request, const AvoiderOptions& options);

}  // namespace trackbed
