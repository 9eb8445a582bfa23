#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// Exact courses of straights, arcs and curvature ramps, given piece by piece: proving grounds and
/// steps of curvature for controllers. They do not avoid obstacles.
///
/// Symbols: kappa curvature [1/m], positive to the left; a ramp is a clothoid, kappa linear in the
/// distance.
namespace trackbed {

/// One piece: a constant `curvature`, or a ramp from one to another.
struct CoursePiece {
  double length = 0.0;                   ///< [m], > 0
  std::optional<double> curvature;       ///< kappa of a straight (0) or an arc [1/m]
  std::optional<double> curvature_from;  ///< of a ramp [1/m]; none: the end of the previous piece
  std::optional<double> curvature_to;    ///< of a ramp [1/m]
};
void Visit(KeyVisitor& keys, CoursePiece& piece);

struct CourseOptions {
  std::vector<CoursePiece> segments;  ///< from the car's start on, at least one
};
void Visit(KeyVisitor& keys, CourseOptions& options);

/// The pieces as segments of a path, forwards. InternalError unless every piece is either constant
/// or a ramp.
std::vector<Segment> CourseSegments(const CourseOptions& options);

/// A piece of the course as planned.
struct CourseSegmentFindings {
  double start = 0.0;                 ///< station [m]
  double length = 0.0;                ///< [m]
  double curvature_from = 0.0;        ///< [rad/m]
  double curvature_to = 0.0;          ///< [rad/m]
  double lateral_acceleration = 0.0;  ///< largest, at the mission's speed [m/s^2]
};
void Visit(DiagnosticsVisitor& out, const CourseSegmentFindings& own);

struct CourseDiagnostics {
  std::optional<std::size_t> failed_segment;  ///< the first one that the car cannot steer
  std::vector<CourseSegmentFindings> segments;
};
void Visit(DiagnosticsVisitor& out, const CourseDiagnostics& own);

/// The planner `course`.
PlannerEntry CoursePlanner();

}  // namespace trackbed
