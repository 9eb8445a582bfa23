#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "trackbed/path/path.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/common/planner.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/steering_schedule.h"

/// Plans exact courses that are given piece by piece, as straights, arcs and curvature ramps. Exact
/// courses can model proving grounds, or test how controllers react to steps of curvature. The
/// planner `course` does not avoid obstacles.
///
/// Symbols: kappa is the curvature [1/m], positive to the left. On a curvature ramp (a clothoid),
/// the curvature kappa is linear in the distance.
namespace trackbed {

/// One piece of a course, which has either a constant `curvature`, or a ramp between two curvatures
/// that is linear in the distance.
struct CoursePiece {
  double length = 0.0;              ///< Length of the course piece [m], > 0.
  std::optional<double> curvature;  ///< Curvature kappa of an arc, or 0 for a straight [1/m].
  /// Curvature at the start of a curvature ramp [1/m]; none: the curvature at the previous piece's
  /// end.
  std::optional<double> curvature_from;
  std::optional<double> curvature_to;  ///< Curvature at the end of a curvature ramp [1/m].
};
void Visit(KeyVisitor& keys, CoursePiece& piece);

struct CourseOptions {
  /// Pieces of the course, in order from the car's start; at least one piece, and together at most
  /// kMaxPathLength long.
  std::vector<CoursePiece> segments;
};
void Visit(KeyVisitor& keys, CourseOptions& options);

/// Converts the pieces of a course to the segments of a forward path. Throws InternalError unless
/// every piece of the course has either a constant curvature or a curvature ramp.
std::vector<Segment> CourseSegments(const CourseOptions& options);

/// Diagnostics of a piece of the planned course.
struct CourseSegmentFindings {
  double start = 0.0;           ///< Station at the start of the course piece [m].
  double length = 0.0;          ///< Length of the course piece [m].
  double curvature_from = 0.0;  ///< Curvature at the start of the course piece [rad/m].
  double curvature_to = 0.0;    ///< Curvature at the end of the course piece [rad/m].
  /// Largest lateral acceleration on the course piece at the mission's speed [m/s^2].
  double lateral_acceleration = 0.0;
};
void Visit(DiagnosticsVisitor& out, const CourseSegmentFindings& own);

struct CourseDiagnostics {
  /// Index of the first course piece whose curvature is too large for the car's steering.
  std::optional<std::size_t> failed_segment;
  std::vector<CourseSegmentFindings> segments;
};
void Visit(DiagnosticsVisitor& out, const CourseDiagnostics& own);

/// Returns the planner `course`.
PlannerEntry CoursePlanner();

}  // namespace trackbed
