#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// An exact course of straights, arcs and curvature ramps, as given piece by piece: proving grounds
/// and steps of curvature for controllers, not a way around anything.
///
/// Symbols: kappa curvature [1/m], positive to the left; a ramp is a clothoid, kappa linear in the
/// distance.
namespace trackbed {

/// One piece: a constant `curvature`, or a ramp from one to another.
struct CoursePiece {
  double length = 0.0;                   ///< [m], > 0
  std::optional<double> curvature;       ///< kappa of a straight (0) or an arc [1/m]
  std::optional<double> curvature_from;  ///< of a ramp [1/m]; none: where the piece before ended
  std::optional<double> curvature_to;    ///< of a ramp [1/m]
};

struct CourseOptions {
  std::vector<CoursePiece> segments;  ///< from the car's start on, at least one
};

/// The pieces as segments of a path, forwards. InternalError unless every piece is either constant
/// or a ramp.
std::vector<Segment> CourseSegments(const CourseOptions& options);

/// The sharpest curvature of a segment that is linear in the distance [1/m].
double SharpestCurvature(const Segment& segment);

/// The steering over the distance that leads a kinematic car along the segments: atan(L kappa).
/// Steps of curvature are driven as the ramps of RampsOfSteps (curvature_steps.h) for a car that
/// goes at `speed` [m/s], more slowly within `caps`. Where the car stands, at changes of direction
/// and at `stops`, the step lies in the last micrometer before.
SteeringSchedule CourseSchedule(const VehicleParams& vehicle, const std::vector<Segment>& segments,
                                double speed, const std::vector<SpeedCap>& caps = {},
                                const std::vector<double>& stops = {});

}  // namespace trackbed
