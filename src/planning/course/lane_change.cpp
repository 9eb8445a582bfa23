#include "trackbed/planning/course/lane_change.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"
#include "trackbed/path/bezier.h"
#include "trackbed/vehicle/steering_reach.h"
#include "trackbed/world/world.h"

// Plans the double lane changes of ISO 3888-1 and ISO 3888-2.
// 1. MakeCourse computes the lengths, widths and offsets of the gates from the width of the car
//    (tables in lane_change.h).
// 2. Inside a gate, the path is straight. Between two gates, the path is a quintic Bezier curve
//    without curvature at its ends.
// 3. The plan is refused if a curve needs more than the steering limit.
// 4. GateMargins measures the distance of the corners of the footprint from the edges of each gate.
namespace trackbed {
namespace {

/// Dimensions of the lane-change course: the lengths of its five sections and the widths of its
/// three gates. The lateral offsets are those of the second and third gate's center from the first
/// gate's center.
struct Course {
  std::array<double, 5> lengths;
  std::array<double, 3> widths;
  std::array<double, 3> offsets;
};

Course MakeCourse(LaneChangeStandard standard, double width) {
  const double first = 1.1 * width + 0.25;
  if (standard == LaneChangeStandard::kIso3888_1) {
    const double second = 1.2 * width + 0.25;
    const double third = 1.3 * width + 0.25;
    return {{15.0, 30.0, 25.0, 25.0, 30.0},
            {first, second, third},
            {0.0, 3.5 + 0.5 * (second - first), 0.5 * (third - first)}};
  }
  const double second = width + 1.0;
  const double third = std::max(1.3 * width + 0.25, 3.0);
  return {{12.0, 13.5, 11.0, 12.5, 12.0},
          {first, second, third},
          {0.0, 0.5 * first + 1.0 + 0.5 * second, 0.5 * (third - first)}};
}

void AddStraight(double length, std::vector<Segment>& path) {
  if (length > 0.0) {
    path.push_back({length, 0.0});
  }
}

/// Appends to `path` a lateral shift to the left by `offset` over `length`; the curvature is zero
/// at both ends.
void AddChange(double length, double offset, std::vector<Segment>& path) {
  constexpr double kSpacing = 0.1;  // [m]
  std::vector<Vec2> control;
  for (int i = 0; i <= 5; ++i) {
    control.emplace_back(length * i / 5.0, i < 3 ? 0.0 : offset);
  }
  const auto segments = SegmentsThrough(BezierCurve(control).Points(kSpacing, 0.0));
  path.insert(path.end(), segments.begin(), segments.end());
}

}  // namespace

std::vector<Gate> LaneChangeGates(LaneChangeStandard standard, Side first, double vehicle_width,
                                  const Pose2& start) {
  const Course course = MakeCourse(standard, vehicle_width);
  const double side = first == Side::kLeft ? 1.0 : -1.0;
  std::vector<Gate> gates;
  double x = 0.0;
  for (std::size_t section = 0; section < 5; ++section) {
    const double length = course.lengths[section];
    if (section % 2 == 0) {
      const std::size_t gate = section / 2;
      const Vec2 center = ToWorld(start, Vec2(x + 0.5 * length, side * course.offsets[gate]));
      gates.push_back({static_cast<int>(section) + 1,
                       {{center.x(), center.y(), start.yaw}, length, course.widths[gate]}});
    }
    x += length;
  }
  return gates;
}

std::vector<Vec2> GateCones(const Gate& gate) {
  constexpr int kPairs = 5;
  constexpr double kRadius = 0.15;  // [m]
  const OrientedBox& lane = gate.lane;
  std::vector<Vec2> cones;
  for (int i = 0; i < kPairs; ++i) {
    const double x = lane.length * (static_cast<double>(i) / (kPairs - 1) - 0.5);
    const double y = 0.5 * lane.width + kRadius;
    cones.push_back(ToWorld(lane.center, Vec2(x, y)));
    cones.push_back(ToWorld(lane.center, Vec2(x, -y)));
  }
  return cones;
}

std::optional<double> ReleaseStation(const LaneChangePlannerOptions& options,
                                     const VehicleParams& vehicle) {
  if (!options.release) {
    return std::nullopt;
  }
  const double front = vehicle.length - vehicle.rear_overhang;  // ahead of the rear axle
  return options.lead_in + *options.release - front;
}

std::vector<Segment> LaneChangePath(const LaneChangePlannerOptions& options,
                                    const std::vector<Gate>& gates, const Pose2& start,
                                    double stop) {
  std::vector<Segment> path;
  double x = 0.0;
  double y = 0.0;
  for (std::size_t i = 0; i < gates.size(); ++i) {
    const OrientedBox& lane = gates[i].lane;
    const Vec2 middle = ToLocal(start, lane.center.position());
    const double begin = middle.x() - 0.5 * lane.length;
    const double end = middle.x() + 0.5 * lane.length;
    if (i > 0) {
      const double joined = begin + options.join;
      TRACKBED_CHECK(joined > x, "gate {} is joined before the one before it is left", i);
      AddChange(joined - x, middle.y() - y, path);
      x = joined;
      y = middle.y();
    }
    const double left = i + 1 < gates.size() ? end - options.leave : end + options.lead_out + stop;
    AddStraight(left - x, path);
    x = std::max(x, left);
  }
  return path;
}

std::vector<double> GateMargins(const std::vector<Gate>& gates, const VehicleParams& vehicle,
                                const std::vector<Pose2>& poses) {
  std::vector<double> margins(gates.size(), std::numeric_limits<double>::infinity());
  for (std::size_t g = 0; g < gates.size(); ++g) {
    const OrientedBox& lane = gates[g].lane;
    const auto take = [&](const Vec2& corner) {
      margins[g] = std::min(margins[g], 0.5 * lane.width - std::abs(corner.y()));
    };
    std::array<Vec2, 4> before{};
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const std::array<Vec2, 4> corners = FootprintAt(vehicle, poses[i]).Corners();
      for (std::size_t c = 0; c < corners.size(); ++c) {
        const Vec2 corner = ToLocal(lane.center, corners[c]);
        if (std::abs(corner.x()) <= 0.5 * lane.length) {
          take(corner);
        }
        // Also check the poses, between two sampled poses, at which a corner of the car passes the
        // cones at the ends of the lane.
        for (const double end : {-0.5 * lane.length, 0.5 * lane.length}) {
          if (i > 0 && (before[c].x() - end) * (corner.x() - end) < 0.0) {
            take(before[c] +
                 (end - before[c].x()) / (corner.x() - before[c].x()) * (corner - before[c]));
          }
        }
        before[c] = corner;
      }
    }
  }
  return margins;
}

namespace {

Plan PlanWith(const LaneChangePlannerOptions& options, const PlanRequest& request) {
  const Pose2& start = request.start;
  const Vec2 first = ToWorld(start, Vec2(options.lead_in, 0.0));
  Plan plan;
  plan.gates = LaneChangeGates(options.standard, options.first, request.vehicle.width,
                               {first.x(), first.y(), start.yaw});
  const double speed = request.speed.speed;
  const double stop = 0.5 * speed * speed / request.speed.deceleration;
  const std::vector<Segment> segments = LaneChangePath(options, plan.gates, start, stop);
  for (const Segment& segment : segments) {
    const double steering = std::abs(SteeringForCurvature(request.vehicle, segment.curvature));
    const double reach = SteeringReach(request.vehicle, segment.curvature);
    if (steering > reach) {
      plan.gates.clear();
      plan.status = PlanStatus::kTurnTooTight;
      plan.reason =
          fmt::format("steering angle {:.3f} rad between the gates exceeds the limit of {:.3f} rad",
                      steering, reach);
      return plan;
    }
  }
  plan.reference.path = Path(start, segments);
  const Path& path = plan.reference.path;
  plan.reference.speed = StopAtEnd(path.length(), request.start_speed, request.speed);
  plan.schedule_speed = plan.reference.speed;
  plan.goal = path.At(path.length()).pose;

  constexpr double kSpacing = 0.5;  // [m]
  std::vector<SteeringSchedule::Knot> knots;
  std::vector<Pose2> poses;
  for (const PathPoint& point : path.Sample(kSpacing)) {
    knots.push_back({point.s, SteeringForCurvature(request.vehicle, point.curvature)});
    poses.push_back(point.pose);
  }
  plan.schedule = SteeringSchedule::Through(std::move(knots));

  LaneChangeDiagnostics found;
  const std::vector<double> margins = GateMargins(plan.gates, request.vehicle, poses);
  for (std::size_t i = 0; i < plan.gates.size(); ++i) {
    found.gates.push_back(
        {.gate = plan.gates[i], .cones = GateCones(plan.gates[i]), .planned_margin = margins[i]});
  }
  plan.diagnostics.planner = std::move(found);
  return plan;
}

}  // namespace

void Visit(DiagnosticsVisitor& out, const GateFindings& own) {
  out.Integer("section", own.gate.section);
  out.Number("length_m", own.gate.lane.length);
  out.Number("width_m", own.gate.lane.width);
  out.Number("planned_margin_m", own.planned_margin);
  if (out.full()) {
    out.Points("cones_m", own.cones);
  }
}

void Visit(DiagnosticsVisitor& out, const LaneChangeDiagnostics& own) {
  out.List("gates", own.gates);
}

void Visit(KeyVisitor& keys, LaneChangePlannerOptions& options) {
  static const EnumNames<LaneChangeStandard> standards{
      {LaneChangeStandard::kIso3888_1, "iso_3888_1"},
      {LaneChangeStandard::kIso3888_2, "iso_3888_2"}};
  keys.Field({"standard", "", "standard that defines the gates"}, options.standard, Need::kOptional,
             standards);
  static const EnumNames<Side> sides{{Side::kLeft, "left"}, {Side::kRight, "right"}};
  keys.Field({"first", "", "side of the first lane change"}, options.first, Need::kOptional, sides);
  keys.Field({"lead_in", "m", "distance from the start to the first gate"}, options.lead_in,
             Need::kOptional, kPositive);
  keys.Field({"lead_out", "m", "straight distance after the last gate"}, options.lead_out,
             Need::kOptional, kPositive);
  keys.Field(
      {"leave", "m", "distance before a gate's end at which the rear axle leaves its center line"},
      options.leave, Need::kOptional, Range{.min = -5.0, .max = 5.0});
  keys.Field(
      {"join", "m", "distance after the next gate's start at which it reaches that center line"},
      options.join, Need::kOptional, Range{.min = -5.0, .max = 5.0});
  keys.Field({"release", "m",
              "distance of the car's front behind the start of section 1 at which the throttle is "
              "released; then the car coasts, and the run ends behind the last gate"},
             options.release, kNonNegative);
}

PlannerEntry LaneChangePlanner() {
  return {.name = "lane_change",
          .summary = "double lane change through gates (ISO 3888)",
          .defaults = LaneChangePlannerOptions{},
          .plan = PlanBy<LaneChangePlannerOptions, PlanWith>,
          .has_gates = true};
}

}  // namespace trackbed
