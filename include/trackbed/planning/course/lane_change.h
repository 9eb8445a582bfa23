#pragma once

#include <array>
#include <optional>
#include <vector>

#include "trackbed/geometry/oriented_box.h"
#include "trackbed/path/path.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"

/// Plans the double lane changes of ISO 3888, which lead through three gates of cones.
///
/// The table shows lengths (upper rows) and widths (lower rows) of the course's sections, with w
/// the car's width without mirrors. Sections 2 and 4 have no cones.
///
///   section       1             2     3             4     5
///   ISO 3888-1    15 m          30    25 m          25    30 m          (2018, table 1; its
///                 1.1 w + 0.25        1.2 w + 0.25        1.3 w + 0.25   sections 5 and 6, of 15 m
///                                                                        each, as one)
///   ISO 3888-2    12 m          13.5  11 m          12.5  12 m          (2011, table 1)
///                 1.1 w + 0.25        w + 1               max(1.3 w + 0.25, 3)
///
/// Lane offsets: in part 1 of the standard, the right edge of section 3 lies 3.5 m to the left of
/// the right edge of section 1. In part 2 of the standard, the right edge of section 3 lies 1 m to
/// the left of the left edge of section 1. The right edges of sections 1 and 5 are on one line. The
/// whole course is mirrored if the first lane change is to the right.
namespace trackbed {

enum class LaneChangeStandard { kIso3888_1, kIso3888_2 };

enum class Side { kLeft, kRight };

struct LaneChangePlannerOptions {
  LaneChangeStandard standard = LaneChangeStandard::kIso3888_1;
  /// Side to which the first lane change leads, from section 1 to section 3.
  Side first = Side::kLeft;
  double lead_in = 30.0;  ///< Distance from the car's start to section 1 [m], > 0.
  /// Length of the straight between section 5 and the point at which the car begins to brake [m], >
  /// 0.
  double lead_out = 20.0;
  /// The planned path leaves the middle line of a gate at the distance `leave` before the gate's
  /// end [m]. The planned path reaches the middle line of the next gate at the distance `join`
  /// after that gate's start [m]. Larger values of `leave` and `join` make the transition between
  /// gates longer and less curved, but bring the car nearer to the cones.
  double leave = 0.0;
  double join = 0.0;
  /// Distance of the car's front beyond the beginning of section 1 at which the driver releases the
  /// throttle [m], >= 0. Beyond the release point, the car coasts, and the run ends when the whole
  /// car has passed the last gate. If `release` is nullopt, the car keeps its speed through the
  /// course.
  std::optional<double> release{};
};
void Visit(KeyVisitor& keys, LaneChangePlannerOptions& options);

/// Returns the gates of a lane-change course. The pose `start` is the middle of the beginning of
/// section 1.
std::vector<Gate> LaneChangeGates(LaneChangeStandard standard, Side first, double vehicle_width,
                                  const Pose2& start);

/// Returns the positions of the cones of a gate [m]. Five cones are spread over the length of each
/// edge of the gate, with the inner side of each cone on the edge.
std::vector<Vec2> GateCones(const Gate& gate);

/// Returns the station of the rear axle at which the driver releases the throttle [m]; nullopt if
/// the car keeps its speed.
std::optional<double> ReleaseStation(const LaneChangePlannerOptions& options,
                                     const VehicleParams& vehicle);

/// Computes the path from `start` along the middle lines of the gates. The transition to a gate
/// with the lateral offset h is the curve y = h (10 u^3 - 15 u^4 + 6 u^5), with u from 0 to 1 along
/// the transition. The curvature of the transition curve is continuous, 0 at both ends and at most
/// 5.77 h/length^2 for the lateral offset h. The transition curve between gates is approximated by
/// arcs that are at most 0.1 m long. Between neighboring arcs of the transition, the curvature
/// steps by less than 6 m h/length^3 for the lateral offset h. The path ends at the distance
/// `lead_out` plus `stop` beyond the last gate.
std::vector<Segment> LaneChangePath(const LaneChangePlannerOptions& options,
                                    const std::vector<Gate>& gates, const Pose2& start,
                                    double stop);

/// Returns the margin of the driven car to each gate [m]. The margin to a gate is the smallest
/// distance from a corner of the car's footprint to an edge of the gate, while the corner was
/// between the gate's ends. The margin to a gate is negative if a corner of the car was outside of
/// the gate, and infinite if no corner reached the gate. GateMargins assumes that the car moves
/// straight between the given poses of its rear axle.
std::vector<double> GateMargins(const std::vector<Gate>& gates, const VehicleParams& vehicle,
                                const std::vector<Pose2>& poses);

/// A gate of the course, and the distance that a car on the planned path keeps from the gate's
/// edges.
struct GateFindings {
  Gate gate;
  std::vector<Vec2> cones;  ///< Positions of the gate's cones [m].
  /// Margin of the planned path to the gate, as defined by GateMargins [m].
  double planned_margin = 0.0;
};
void Visit(DiagnosticsVisitor& out, const GateFindings& own);

struct LaneChangeDiagnostics {
  std::vector<GateFindings> gates;
};
void Visit(DiagnosticsVisitor& out, const LaneChangeDiagnostics& own);

/// Returns the planner `lane_change`.
PlannerEntry LaneChangePlanner();

}  // namespace trackbed
