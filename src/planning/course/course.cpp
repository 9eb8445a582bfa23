#include "trackbed/planning/course/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/vehicle/steering_reach.h"

namespace trackbed {

std::vector<Segment> CourseSegments(const CourseOptions& options) {
  TRACKBED_CHECK(!options.segments.empty(), "a course without segments");
  std::vector<Segment> segments;
  double end = 0.0;
  for (const CoursePiece& piece : options.segments) {
    TRACKBED_CHECK(piece.length > 0.0, "a piece of {} m", piece.length);
    TRACKBED_CHECK(piece.curvature.has_value() != piece.curvature_to.has_value() &&
                       !(piece.curvature && piece.curvature_from),
                   "a piece of {} m is neither constant nor a ramp", piece.length);
    const double from = piece.curvature.value_or(piece.curvature_from.value_or(end));
    end = piece.curvature_to.value_or(from);
    segments.push_back({.length = piece.length,
                        .curvature = from,
                        .direction = 1,
                        .sharpness = (end - from) / piece.length});
  }
  return segments;
}

namespace {

/// Splits ramps that turn by more than a full circle into pieces that turn by at most 1 rad each.
/// The cost of a point on a ramp is proportional to the turn of the ramp, so without the split the
/// cost of a course would grow with the square of its turns.
std::vector<Segment> SplitLongRamps(const std::vector<Segment>& segments) {
  std::vector<Segment> pieces;
  for (const Segment& segment : segments) {
    const double turn = segment.length * std::abs(SharpestCurvature(segment));
    const double count = segment.sharpness == 0.0 || turn <= 2.0 * kPi ? 1.0 : std::ceil(turn);
    for (double i = 0.0; i < count; i += 1.0) {
      Segment piece = segment;
      piece.length = segment.length / count;
      piece.curvature = segment.CurvatureAt(segment.length * i / count);
      pieces.push_back(piece);
    }
  }
  return pieces;
}

Plan PlanWith(const CourseOptions& options, const PlanRequest& request) {
  const std::vector<Segment> segments = CourseSegments(options);
  Plan plan;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double sharpest = SharpestCurvature(segments[i]);
    const double steering = std::abs(SteeringForCurvature(request.vehicle, sharpest));
    const double reach = SteeringReach(request.vehicle, sharpest);
    if (steering > reach) {
      plan.status = PlanStatus::kTurnTooTight;
      plan.reason = fmt::format(
          "segments[{}]: curvature {:.4g} 1/m needs a steering angle of {:.3f} rad, which exceeds "
          "the limit of {:.3f} rad",
          i, sharpest, steering, reach);
      plan.diagnostics.planner = CourseDiagnostics{.failed_segment = i, .segments = {}};
      return plan;
    }
  }
  plan.reference.path = Path(request.start, SplitLongRamps(segments));
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtEnd(path.length(), request.start_speed, request.speed);
  plan.schedule = CourseSchedule(request.vehicle, segments, request.speed.speed);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;

  CourseDiagnostics found;
  double start = 0.0;
  for (const Segment& segment : segments) {
    const double speed = request.speed.speed;
    found.segments.push_back({.start = start,
                              .length = segment.length,
                              .curvature_from = segment.curvature,
                              .curvature_to = segment.CurvatureAt(segment.length),
                              .lateral_acceleration = SharpestCurvature(segment) * speed * speed});
    start += segment.length;
  }
  plan.diagnostics.planner = std::move(found);
  return plan;
}

/// Reports a problem if the course is longer than kMaxPathLength, which would take too much
/// computing time and memory.
void CheckCourseLength(const CourseOptions& options, std::vector<OptionProblem>& problems) {
  double length = 0.0;
  std::size_t longest = 0;
  for (std::size_t i = 0; i < options.segments.size(); ++i) {
    length += options.segments[i].length;
    longest = options.segments[i].length > options.segments[longest].length ? i : longest;
  }
  if (length > kMaxPathLength) {
    problems.push_back(
        {fmt::format("segments[{}].length", longest),
         fmt::format("the course is {:.7g} m long; must be at most {:.7g} m: this segment, the "
                     "longest one, is {:.7g} m; correct it, or divide the course",
                     length, kMaxPathLength, options.segments[longest].length)});
  }
}

/// Reports a problem unless the course has at least one segment, is at most kMaxPathLength long,
/// and each segment has either a constant curvature or a curvature ramp.
std::vector<OptionProblem> CheckSegments(const CourseOptions& options,
                                         const CouldReadKey& could_read) {
  std::vector<OptionProblem> problems;
  if (options.segments.empty() && could_read("segments")) {
    problems.push_back({"segments", "a course needs at least one segment"});
  }
  for (std::size_t i = 0; i < options.segments.size(); ++i) {
    const CoursePiece& piece = options.segments[i];
    const std::string key = fmt::format("segments[{}]", i);
    if (!could_read(key) || !could_read(key + ".curvature") ||
        !could_read(key + ".curvature_from") || !could_read(key + ".curvature_to")) {
      continue;
    }
    if (piece.curvature && (piece.curvature_from || piece.curvature_to)) {
      problems.push_back({key, "give curvature or curvature_to, not both"});
    } else if (!piece.curvature && !piece.curvature_to) {
      problems.push_back({key, "give curvature (0 for a straight), or curvature_to for a ramp"});
    }
  }
  CheckCourseLength(options, problems);
  return problems;
}

std::optional<double> StartCurvature(const CourseOptions& options, const RouteStart& /*route*/) {
  if (options.segments.empty()) {
    return std::nullopt;
  }
  const CoursePiece& first = options.segments.front();
  return first.curvature.value_or(first.curvature_from.value_or(0.0));
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const CourseSegmentFindings& own) {
  out.Number("start_s_m", own.start);
  out.Number("length_m", own.length);
  out.Number("curvature_from_radpm", own.curvature_from);
  out.Number("curvature_to_radpm", own.curvature_to);
  out.Number("lateral_acceleration_mps2", own.lateral_acceleration);
}

void Visit(DiagnosticsVisitor& out, const CourseDiagnostics& own) {
  if (own.failed_segment) {
    out.Integer("segment", *own.failed_segment);
  } else {
    out.List("segments", own.segments);
  }
}

void Visit(KeyVisitor& keys, CoursePiece& piece) {
  static constexpr Range kCurvature{.min = -10.0, .max = 10.0};  // [1/m]
  keys.Field({"length", "m", "length"}, piece.length, Need::kRequired,
             Range{.max = 1e6, .above = 0.0});
  keys.Field({"curvature", "1/m", "curvature of a straight (0) or arc, positive to the left"},
             piece.curvature, kCurvature);
  keys.Field({"curvature_from", "1/m",
              "initial curvature of a ramp; default: end of the previous segment"},
             piece.curvature_from, kCurvature);
  keys.Field({"curvature_to", "1/m", "final curvature of a ramp"}, piece.curvature_to, kCurvature);
}

void Visit(KeyVisitor& keys, CourseOptions& options) {
  keys.List({"segments", "", "segments of the course, from the car's start, at least one"},
            options.segments);
}

PlannerEntry CoursePlanner() {
  return {.name = "course",
          .summary = "straights, arcs and curvature ramps as given",
          .defaults = CourseOptions{},
          .plan = PlanBy<CourseOptions, PlanWith>,
          .check = OnOptions<CourseOptions, CheckSegments>,
          .start_curvature = OnOptions<CourseOptions, StartCurvature>};
}

}  // namespace trackbed
