#include "trackbed/planning/path_file/path_file_planner.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/path_files/path_file.h"
#include "trackbed/planning/common/course_schedule.h"

namespace trackbed {
namespace {

/// Returns the remedy if the points turn back because of noise.
std::string NoiseRemedy(const FittedPath& fitted) {
  if (!fitted.noise_deviation) {
    return "";
  }
  return fmt::format(
      "; if this is noise of the positions, use fit: spline with max_deviation: {:.2g}",
      *fitted.noise_deviation);
}

/// Returns speed caps that follow the speeds in the file; between two points, the cap is the mean
/// of the speeds at these points.
std::vector<SpeedCap> CapsOf(const FittedPath& fitted) {
  // Lower bound of the speed caps [m/s], since the speed is 0 at the start and end of a trajectory.
  constexpr double kMinSpeed = 0.1;
  const std::vector<double>& speed = fitted.given.speed;
  std::vector<SpeedCap> caps;
  for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
    const double from = fitted.stations[i];
    const double to = fitted.stations[i + 1];
    if (to > from) {
      caps.push_back({from, to, std::max(0.5 * (speed[i] + speed[i + 1]), kMinSpeed)});
    }
  }
  // On a closed path, add a cap from the last point back to the first point.
  const double length = fitted.path.length();
  if (!speed.empty() && fitted.options.closed && fitted.stations.back() < length) {
    caps.push_back({fitted.stations.back(), length,
                    std::max(0.5 * (speed.back() + speed.front()), kMinSpeed)});
  }
  return caps;
}

/// Makes the steering schedule of the fitted path. On a path with continuous curvature and no
/// heading jumps, the steering schedule follows the curvature.
SteeringSchedule ScheduleOf(const FittedPath& fitted, const PlanRequest& request,
                            const std::vector<SpeedCap>& caps) {
  const Path& path = fitted.path;
  if (!fitted.jumps.empty()) {
    return CourseSchedule(request.vehicle, path.segments(), request.speed.speed, caps);
  }
  std::vector<SteeringSchedule::Knot> knots;
  double s = 0.0;
  for (const Segment& segment : path.segments()) {
    knots.push_back({s, SteeringForCurvature(request.vehicle, segment.curvature)});
    s += segment.length;
  }
  const Segment& last = path.segments().back();
  knots.push_back({s, SteeringForCurvature(request.vehicle, last.CurvatureAt(last.length))});
  return SteeringSchedule::Through(std::move(knots));
}

Plan PlanWith(const PathFileOptions& options, const PlanRequest& request) {
  Plan plan;
  if (options.path == nullptr) {
    plan.status = PlanStatus::kNoPath;
    plan.reason = "no path was read from a file";
    return plan;
  }
  const FittedPath& fitted = *options.path;
  if (!fitted.reversals.empty()) {
    const HeadingJump& first = fitted.reversals.front();
    plan.status = PlanStatus::kUTurn;
    plan.reason = fmt::format("the path turns back on itself by {:.3g} rad at ({:.6g}, {:.6g})",
                              std::abs(first.angle), first.position.x(), first.position.y());
    plan.reason += NoiseRemedy(fitted);
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
  plan.reference.path = fitted.path;
  const double length = fitted.path.length();
  if (options.speeds == PathSpeeds::kFile) {
    plan.caps = CapsOf(fitted);
  }
  plan.reference.speed = StopAtEnd(length, request.start_speed, request.speed, plan.caps);
  plan.schedule = ScheduleOf(fitted, request, plan.caps);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = fitted.path.At(length).pose;
  if (options.notes) {
    std::istringstream lines(*options.notes);
    for (std::string line; std::getline(lines, line);) {
      plan.notes.push_back(line);
    }
  }
  plan.notes.push_back(Describe(fitted));
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
    options.path = Fit(std::move(found.points), options, file.string());
  });
}

std::optional<PlannedStart> StartOf(const PathFileOptions& options) {
  if (options.path == nullptr) {
    return std::nullopt;
  }
  PlannedStart start{.pose = options.path->path.At(0.0).pose};
  const std::vector<double>& speed = options.path->given.speed;
  if (options.speeds == PathSpeeds::kFile && !speed.empty()) {
    start.speed = speed.front();
  }
  return start;
}

std::vector<InputFile> InputFilesOf(const PathFileOptions& options) {
  if (options.path == nullptr) {
    return {};
  }
  return {{kPathCsv, PathCsv(options.path->given), "path " + options.file}};
}

void Resolve(PathFileOptions& options) {
  options.file = kPathCsv;
  options.map = {};  // the output of PathCsv uses the default column names
  options.ahead = 0.0;
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

std::string Describe(const FittedPath& fitted) {
  std::string text =
      fitted.options.fit == PathFit::kSpline
          ? fmt::format("spline within {:.3g} m of {} points, smoothing length {:.3g} m",
                        fitted.deviation, fitted.given.points.size(), fitted.smoothing_length)
          : fmt::format("polyline of {} points, within {:.3g} m", fitted.given.points.size(),
                        fitted.deviation);
  if (fitted.bulge > fitted.options.max_deviation) {
    text += fmt::format(", up to {:.3g} m beside the straight lines between them at s = {:.4g} m",
                        fitted.bulge, fitted.bulge_station);
  }
  if (fitted.options.resample) {
    text += fmt::format(", resampled every {:.3g} m", *fitted.options.resample);
  }
  if (fitted.options.closed) {
    text += ", closed";
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
std::optional<double> StartCurvature(const PathFileOptions& options, const RouteStart& /*route*/) {
  return options.path == nullptr ? std::nullopt
                                 : std::optional(options.path->path.At(0.0).curvature);
}

             options.fit.max_deviation, Need::kOptional, Range{.min = 1e-6, .max = 100.0});
  keys.Field({"closed", "", "whether the path leads back to its first point"}, options.fit.closed,
             Need::kOptional);
  keys.Field({"resample", "m", "distance of the points that are fitted; default: as in the file"},
             options.fit.resample, Range{.min = 1e-3, .max = 1e3});
  static const EnumNames<PathSpeeds> speeds{{PathSpeeds::kMission, "mission"},
                                            {PathSpeeds::kFile, "file"}};
  keys.Field({"speeds", "",
              "the mission's speed, or at most those of the file, from point to point their mean"},
             options.speeds, Need::kOptional, speeds);
  keys.Field({"notes", "", "what was found in the file, a line for each remark; runs write it"},
             options.notes);
}

PlannerEntry PathFilePlanner() {
  static const std::string summary = "the path in a file, of any planner: " + PathFormatList();
  return {.name = "path_file",
          .summary = summary.c_str(),
          .defaults = PathFileOptions{},
          .plan = PlanBy<PathFileOptions, PlanWith>,
          .start = OnOptions<PathFileOptions, StartOf>,
          .read_inputs = OnOptions<PathFileOptions, ReadPath>,
          .input_files = OnOptions<PathFileOptions, InputFilesOf>,
          .input_names = {kPathCsv},
          .resolve = OnOptions<PathFileOptions, Resolve>};
}

}  // namespace trackbed
          .start_curvature = OnOptions<PathFileOptions, StartCurvature>,
