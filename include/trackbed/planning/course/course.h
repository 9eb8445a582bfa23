#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// Plans exact courses of straights, arcs and curvature ramps, which are given piece by piece. Such
/// courses model proving grounds, or test controllers with steps of curvature. The planner does not
/// avoid obstacles.
///
/// Symbols: kappa curvature [1/m], positive to the left. On a ramp (a clothoid), kappa is linear in
/// the distance.
namespace trackbed {

/// One piece of a course: a constant `curvature`, or a ramp from one curvature to another.
struct CoursePiece {
  double length = 0.0;              ///< Length [m], > 0.
  std::optional<double> curvature;  ///< Curvature kappa of a straight (0) or an arc [1/m].
  /// Initial curvature of a ramp [1/m]; none: the curvature at the end of the previous piece.
  std::optional<double> curvature_from;
  std::optional<double> curvature_to;  ///< Final curvature of a ramp [1/m].
};
void Visit(KeyVisitor& keys, CoursePiece& piece);

struct CourseOptions {
  std::vector<CoursePiece> segments;  ///< Pieces from the car's start on, at least one.
};
void Visit(KeyVisitor& keys, CourseOptions& options);

/// Converts the pieces to the segments of a forward path. Throws InternalError unless every piece
/// is either constant or a ramp.
std::vector<Segment> CourseSegments(const CourseOptions& options);

/// Findings on a piece of the planned course.
struct CourseSegmentFindings {
  double start = 0.0;           ///< Start station [m].
  double length = 0.0;          ///< Length [m].
  double curvature_from = 0.0;  ///< Initial curvature [rad/m].
  double curvature_to = 0.0;    ///< Final curvature [rad/m].
  /// Largest lateral acceleration at the mission's speed [m/s^2].
  double lateral_acceleration = 0.0;
};
void Visit(DiagnosticsVisitor& out, const CourseSegmentFindings& own);

struct CourseDiagnostics {
  /// Index of the first piece that the car cannot steer.
  std::optional<std::size_t> failed_segment;
  std::vector<CourseSegmentFindings> segments;
};
void Visit(DiagnosticsVisitor& out, const CourseDiagnostics& own);

/// Returns the planner `course`.
PlannerEntry CoursePlanner();

}  // namespace trackbed
