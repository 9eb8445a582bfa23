#include "trackbed/planning/path_file/path_file_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "src/planning/path_file/file_speeds.h"
#include "trackbed/core/error.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/planning/common/course_schedule.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/path_file/steerable_fit.h"
#include "trackbed/vehicle/steering_reach.h"

// The planner `path_file`: drives a path from a file.
// 1. ReadPath reads the points with the map of the scenario, and fits a curve (fit_path.h).
// 2. If the curve is too tight for the car, it is fitted again with the car's curvature as a bound.
// 3. A path that turns back on itself, or whose heading jumps, is refused with a remedy.
// 4. PlanSteps slows the car down, or stops it, where the curvature steps.
// 5. FollowFileSpeeds takes the speeds, stops and waits of the file.
namespace trackbed {
namespace {

// Lowest speed of the car at a curvature step [m/s], equal to that of the curve planners.
constexpr double kMinStepSpeed = 0.3;

bool HasReversePieces(const Path& path) {
  return std::any_of(path.segments().begin(), path.segments().end(),
                     [](const Segment& segment) { return segment.direction < 0; });
}

/// Returns whether the curvature jumps between the cusps, as in a planner's path of arcs and lines.
bool HasCurvatureSteps(const Path& path) {
  constexpr double kSameCurvature = 1e-6;  // [1/m]
  const std::vector<Segment>& segments = path.segments();
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Segment& before = segments[i - 1];
    if (before.direction == segments[i].direction &&
        std::abs(before.CurvatureAt(before.length) - segments[i].curvature) > kSameCurvature) {
      return true;
    }
  }
  return false;
}

/// Makes the steering schedule of the fitted path. On a path with continuous curvature and no
/// heading jumps, the steering schedule follows the curvature. In the schedule, the wheels turn
/// within the last micrometer before a cusp.
SteeringSchedule ScheduleOf(const FittedPath& fitted, const PlanRequest& request,
                            const std::vector<SpeedCap>& caps, const std::vector<double>& stops) {
  const Path& path = fitted.path;
  if (!fitted.jumps.empty() || HasCurvatureSteps(path)) {
    return CourseSchedule(request.vehicle, path.segments(), request.speed.speed, caps, stops);
  }
  constexpr double kTurn = 1e-6;  // [m]
  std::vector<SteeringSchedule::Knot> knots;
  double s = 0.0;
  const Segment* before = nullptr;
  for (const Segment& segment : path.segments()) {
    if (before != nullptr && before->direction != segment.direction) {
      const double turn = std::min(kTurn, 0.5 * before->length);
      knots.push_back({s - turn, SteeringForCurvature(request.vehicle,
                                                      before->CurvatureAt(before->length - turn))});
    }
    knots.push_back({s, SteeringForCurvature(request.vehicle, segment.curvature)});
    s += segment.length;
    before = &segment;
  }
  const Segment& last = path.segments().back();
  knots.push_back({s, SteeringForCurvature(request.vehicle, last.CurvatureAt(last.length))});
  return SteeringSchedule::Through(std::move(knots));
}

/// Returns why the car cannot steer the path, with the `max_deviation` that helps; empty if the car
/// can steer the path, or if no `max_deviation` helps.
std::string NoiseProblem(const FittedPath& fitted, const VehicleParams& vehicle) {
  const SharpestPoint sharpest = SharpestPointOf(fitted.path);
  const double angle = SteeringForCurvature(vehicle, sharpest.curvature);
  const double limit = SteeringReach(vehicle, 0.0);
  if (!fitted.jumps.empty() || angle <= limit) {
    return "";
  }
  const std::optional<double> helps = SteerableDeviation(fitted, vehicle);
  if (!helps) {
    return "";
  }
  const Vec2 at = fitted.path.At(sharpest.station).pose.position();
  return fmt::format(
      "the path is not feasible: steering angle {:.3g} rad exceeds {:.3g} rad at s = {:.4g} m, "
      "({:.6g}, {:.6g}); if the path bends there because of noise of the points, set "
      "plan.max_deviation to at least {:.3g}",
      angle, limit, sharpest.station, at.x(), at.y(), *helps);
}

Plan PlanWith(const PathFileOptions& options, const PlanRequest& request) {
  Plan plan;
  if (options.path == nullptr) {
    plan.status = PlanStatus::kNoPath;
    plan.reason = "no path was read from a file";
    return plan;
  }
  const std::optional<SteerableFit> steerable = FitWithinSteering(*options.path, request.vehicle);
  const FittedPath& fitted = steerable ? steerable->path : *options.path;
  if (!fitted.reversals.empty()) {
    const HeadingJump& first = fitted.reversals.front();
    plan.status = PlanStatus::kUTurn;
    plan.reason = fmt::format("the path turns back on itself by {:.3g} rad at ({:.6g}, {:.6g})",
                              std::abs(first.angle), first.position.x(), first.position.y());
    plan.reason += ReversalRemedy(fitted, "use fit: spline with max_deviation:");
    return plan;
  }
  plan.diagnostics.planner = DiagnosticsOf(fitted);
  const auto largest = std::max_element(
      fitted.jumps.begin(), fitted.jumps.end(),
      [](const auto& a, const auto& b) { return std::abs(a.angle) < std::abs(b.angle); });
  if (largest != fitted.jumps.end() && request.infeasible != InfeasiblePolicy::kAllow) {
    plan.status = PlanStatus::kTurnTooTight;
    plan.reason = fmt::format(
        "the heading jumps at {} points, by up to {:.3g} rad at s = {:.4g} m, ({:.6g}, {:.6g}); "
        "use fit: spline, or infeasible: allow to drive it as it is",
        fitted.jumps.size(), largest->angle, largest->s, largest->position.x(),
        largest->position.y());
    return plan;
  }
  if (request.infeasible != InfeasiblePolicy::kAllow) {
    if (const std::string wrong = NoiseProblem(fitted, request.vehicle); !wrong.empty()) {
      plan.status = PlanStatus::kInfeasible;
      plan.reason = wrong;
      return plan;
    }
  }
  plan.reference.path = fitted.path;
  if (HasReversePieces(fitted.path)) {
    plan.diagnostics.direction_changes = CuspsOf(fitted.path).size();
  }
  const double length = fitted.path.length();
  if (fitted.jumps.empty() && HasCurvatureSteps(fitted.path)) {
    StepSpeeds steps = PlanSteps(request.vehicle, fitted.path.segments(), kMinStepSpeed);
    plan.caps = std::move(steps.caps);
    plan.stops = std::move(steps.stops);
  }
  if (options.speeds == PathSpeeds::kFile) {
    FollowFileSpeeds(plan, fitted, request.start_speed);
  }
  SetSpeeds(plan, request.start_speed, request.speed);
  plan.schedule = ScheduleOf(fitted, request, plan.caps, plan.stops);
  plan.goal = fitted.path.At(length).pose;
  if (options.notes) {
    std::istringstream lines(*options.notes);
    for (std::string line; std::getline(lines, line);) {
      plan.notes.push_back(line);
    }
  }
  plan.notes.push_back(Describe(fitted));
  if (steerable) {
    plan.notes.push_back(steerable->note);
  }
  return plan;
}

/// Fits a path to the points. Throws InputError if no path can be fitted; the error names the file,
/// or the option key if an option is the cause.
std::shared_ptr<const FittedPath> Fit(PathPoints points, const PathFileOptions& options,
                                      const std::string& file) {
  try {
    return std::make_shared<const FittedPath>(
        FitPath(AtRearAxle(std::move(points), options.ahead), options.fit));
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& problem : problems) {
      problem.file = problem.key.empty() ? file : problem.file;
    }
    throw InputError(std::move(problems));
  }
}

void ReadPath(PathFileOptions& options, InputReader& reader) {
  const std::vector<std::pair<std::string, std::string>> wrong = PathMapProblems(options.map);
  for (const auto& [key, message] : wrong) {
    reader.AddError(key, message);
  }
  if (!wrong.empty() || options.file.empty() || !reader.CouldRead("max_deviation") ||
      !reader.CouldRead("resample") || !reader.CouldRead("columns") || !reader.CouldRead("file")) {
    return;
  }
  reader.ReadFile("file", options.file, [&](const std::filesystem::path& file) {
    PathFile found = ReadPathFile(file, options.map);
    if (!options.notes) {
      options.notes = fmt::format("{}", fmt::join(found.notes, "\n"));
    }
    const bool needs_speeds = options.speeds == PathSpeeds::kFile;
    if (needs_speeds && found.speed_problems.empty() && found.points.speed.empty()) {
      found.speed_problems.push_back(
          {.file = file.string(),
           .key = "speed",
           .message = "the file has no speeds; name their column by columns.speed, or set speeds: "
                      "mission"});
    }
    if (needs_speeds && !found.speed_problems.empty()) {
      throw InputError(std::move(found.speed_problems));
    }
    std::shared_ptr<const FittedPath> path = Fit(std::move(found.points), options, file.string());
    if (needs_speeds && path->reversals.empty()) {
      if (std::vector<Problem> problems = FileSpeedProblems(*path, file.string());
          !problems.empty()) {
        throw InputError(std::move(problems));
      }
    }
    options.path = std::move(path);
    options.drawn_lanes = std::move(found.lanes);
  });
  if (options.lanes && reader.CouldRead("lanes")) {
    reader.ReadFile("lanes", *options.lanes, [&](const std::filesystem::path& file) {
      options.drawn_lanes = ReadLanesCsv(file);
    });
  }
}

std::optional<PlannedStart> StartOf(const PathFileOptions& options) {
  if (options.path == nullptr) {
    return std::nullopt;
  }
  PlannedStart start{.pose = options.path->path.At(0.0).pose};
  if (options.path->path.At(0.0).direction < 0) {
    start.speed = 0.0;  // A rolling car drives forwards, so a reverse start is from rest.
  } else if (options.speeds == PathSpeeds::kFile && options.path->reversals.empty()) {
    start.speed = FileStartSpeed(*options.path);
  }
  return start;
}

bool MayReverse(const PathFileOptions& options) {
  return options.path != nullptr && HasReversePieces(options.path->path);
}

std::optional<double> StartCurvature(const PathFileOptions& options, const RouteStart& /*route*/) {
  return options.path == nullptr ? std::nullopt
                                 : std::optional(options.path->path.At(0.0).curvature);
}

std::vector<InputFile> InputFilesOf(const PathFileOptions& options) {
  if (options.path == nullptr) {
    return {};
  }
  std::vector<InputFile> files{{kPathCsv, PathCsv(options.path->given), "path " + options.file}};
  if (!options.drawn_lanes.empty()) {
    const std::string source = options.lanes.value_or(options.file);
    files.push_back({kLanesCsv, LanesCsv(options.drawn_lanes), "lanes " + source});
  }
  return files;
}

std::vector<Vec2> PlacesOf(const PathFileOptions& options) {
  return options.path == nullptr ? std::vector<Vec2>{} : options.path->given.points;
}

void MoveBy(PathFileOptions& options, const Vec2& by) {
  if (options.path == nullptr) {
    return;
  }
  PathPoints moved = options.path->given;
  for (Vec2& point : moved.points) {
    point += by;
  }
  options.path = std::make_shared<const FittedPath>(FitPath(std::move(moved), options.fit));
  for (DrawnLane& lane : options.drawn_lanes) {
    for (std::vector<Vec2>* bound : {&lane.left, &lane.right}) {
      for (Vec2& point : *bound) {
        point += by;
      }
    }
  }
}

void Resolve(PathFileOptions& options) {
  options.file = kPathCsv;
  options.map = {};  // the output of PathCsv uses the default column names
  options.ahead = 0.0;
  options.lanes.reset();
  if (!options.drawn_lanes.empty()) {
    options.lanes = kLanesCsv;
  }
}

}  // namespace

PathFileDiagnostics DiagnosticsOf(const FittedPath& fitted) {
  PathFileDiagnostics own{.points = fitted.given.points.size(),
                          .repeated_points = fitted.repeated,
                          .fit = fitted.options.fit,
                          .deviation = fitted.deviation,
                          .deviation_station = fitted.stations[fitted.deviation_point],
                          .bulge = fitted.bulge,
                          .bulge_station = fitted.bulge_station,
                          .smoothing_length = fitted.smoothing_length,
                          .heading_difference = fitted.heading_difference,
                          .heading_jumps = fitted.jumps.size()};
  for (const HeadingJump& jump : fitted.jumps) {
    own.heading_jump_max = std::max(own.heading_jump_max, std::abs(jump.angle));
  }
  return own;
}

std::string ReversalRemedy(const FittedPath& fitted, const std::string& noise_key) {
  const PathPoints& given = fitted.given;
  std::string text =
      given.direction.empty() && given.yaw.empty()
          ? "; if the car changes its direction of motion there, say so in the file: add a column "
            "direction of 1 and -1, speeds that are negative in reverse, or headings"
          : fmt::format("; the file's {} say that the car keeps its direction of motion there",
                        given.direction.empty() ? "headings" : "directions of motion");
  if (fitted.noise_deviation) {
    // Propose at least the default deviation, because a spline nearer to the points would bend with
    // the noise.
    const double deviation = std::max(*fitted.noise_deviation, PathFitOptions{}.max_deviation);
    // Round the proposed deviation up to two digits, because a smaller deviation would not be
    // enough.
    const double step = std::pow(10.0, std::floor(std::log10(deviation)) - 1.0);
    text += fmt::format("; if this is noise of the positions, {} {:g}", noise_key,
                        step * std::ceil(deviation / step));
  }
  return text;
}

std::string Describe(const FittedPath& fitted) {
  const bool is_followed = fitted.options.fit == PathFit::kSpline &&
                           fitted.smoothing_length == 0.0 && !fitted.given.curvature.empty() &&
                           !fitted.given.yaw.empty();
  std::string text =
      is_followed ? fmt::format("headings and curvatures of the file, within {:.3g} m of {} points",
                                fitted.deviation, fitted.given.points.size())
      : fitted.options.fit == PathFit::kSpline
          ? fmt::format("spline within {:.3g} m of {} points, smoothing length {:.3g} m",
                        fitted.deviation, fitted.given.points.size(), fitted.smoothing_length)
          : fmt::format("polyline of {} points, within {:.3g} m", fitted.given.points.size(),
                        fitted.deviation);
  if (fitted.bulge > fitted.options.max_deviation) {
    text += fmt::format(", up to {:.3g} m beside the straight lines between them at s = {:.4g} m",
                        fitted.bulge, fitted.bulge_station);
  }
  if (const std::vector<double> cusps = CuspsOf(fitted.path); !cusps.empty()) {
    text += fmt::format(", begins {}, changes its direction at s = {:.4g} m",
                        fitted.path.At(0.0).direction > 0 ? "forwards" : "in reverse",
                        fmt::join(cusps, ", "));
  } else if (HasReversePieces(fitted.path)) {
    text += ", driven in reverse";
  }
  if (fitted.options.resample) {
    text += fmt::format(", resampled every {:.3g} m", *fitted.options.resample);
  }
  if (fitted.options.closed) {
    text += ", closed";
  }
  if (fitted.added > 0) {
    text += fmt::format(", {} points added on straight lines beside which it would swing aside",
                        fitted.added);
  }
  if (fitted.merged > 0) {
    text += fmt::format(", {} points merged whose steps turn back", fitted.merged);
  }
  if (fitted.repeated > 0) {
    text += fmt::format(", {} repeated points left out", fitted.repeated);
  }
  constexpr double kMinReportedDifference = 0.1;  // [rad]
  if (fitted.heading_difference > kMinReportedDifference) {
    text += fmt::format("; the file's headings differ from the path's by up to {:.3g} rad",
                        fitted.heading_difference);
  }
  return text;
}

void Visit(DiagnosticsVisitor& out, const PathFileDiagnostics& own) {
  out.Integer("points", own.points);
  out.Integer("repeated_points", own.repeated_points);
  out.Text("fit", own.fit == PathFit::kSpline ? "spline" : "polyline");
  out.Number("deviation_m", own.deviation);
  out.Number("deviation_s_m", own.deviation_station);
  out.Number("bulge_m", own.bulge);
  out.Number("bulge_s_m", own.bulge_station);
  out.Number("smoothing_length_m", own.smoothing_length);
  out.Number("heading_difference_rad", own.heading_difference);
  out.Integer("heading_jumps", own.heading_jumps);
  out.Number("heading_jump_max_rad", own.heading_jump_max);
}

void Visit(KeyVisitor& keys, PathFileOptions& options) {
  keys.Field({"file", "", "the path, relative to this file"}, options.file, Need::kRequired);
  Visit(keys, options.map);
  keys.Field(
      {"ahead", "m",
       "how far ahead of the rear axle, on the car's axis, the file's points are, such as the "
       "center of gravity"},
      options.ahead, Need::kOptional, Range{.min = -10.0, .max = 10.0});
  static const EnumNames<PathFit> fits{{PathFit::kPolyline, "polyline"},
                                       {PathFit::kSpline, "spline"}};
  keys.Field(
      {"fit", "",
       "straight lines from point to point, or a smoothing spline with continuous curvature"},
      options.fit.fit, Need::kOptional, fits);
  keys.Field({"max_deviation", "m", "largest distance of the points from the spline"},
             options.fit.max_deviation, Need::kOptional, Range{.min = 1e-6, .max = 100.0});
  keys.Field({"closed", "", "whether the path leads back to its first point"}, options.fit.closed,
             Need::kOptional);
  keys.Field({"resample", "m", "distance of the points that are fitted; default: as in the file"},
             options.fit.resample, Range{.min = 1e-3, .max = 1e3});
  static const EnumNames<PathSpeeds> speeds{{PathSpeeds::kMission, "mission"},
                                            {PathSpeeds::kFile, "file"}};
  keys.Field(
      {"speeds", "",
       "the mission's speed, or at most those of the file, from point to point their mean, with "
       "a stop where they are 0, for as long as in the file if it has times"},
      options.speeds, Need::kOptional, speeds);
  keys.Field({"lanes", "",
              "CSV file of lanes that films and reports show; default: those of a CommonRoad "
              "scenario or Lanelet2 map; runs write it"},
             options.lanes);
  keys.Field({"notes", "", "what was found in the file, a line for each remark; runs write it"},
             options.notes);
}

PlannerEntry PathFilePlanner() {
  static const std::string summary = "the path in a file, of any planner: " + PathFormatList();
  return {.name = "path_file",
          .summary = summary.c_str(),
          .defaults = PathFileOptions{},
          .plan = PlanBy<PathFileOptions, PlanWith>,
          .may_go_backwards = OnOptions<PathFileOptions, MayReverse>,
          .start = OnOptions<PathFileOptions, StartOf>,
          .start_curvature = OnOptions<PathFileOptions, StartCurvature>,
          .read_inputs = OnOptions<PathFileOptions, ReadPath>,
          .input_files = OnOptions<PathFileOptions, InputFilesOf>,
          .input_names = {kPathCsv, kLanesCsv},
          .resolve = OnOptions<PathFileOptions, Resolve>,
          .places = OnOptions<PathFileOptions, PlacesOf>,
          .translate = OnOptions<PathFileOptions, MoveBy>};
}

}  // namespace trackbed
