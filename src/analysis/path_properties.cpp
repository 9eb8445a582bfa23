#include "trackbed/analysis/path_properties.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "trackbed/planning/common/waypoint_miss.h"

namespace trackbed {
namespace {

using Segments = std::vector<Segment>;

const Segments& SegmentsOf(const PlannedPath& path) {
  return path.plan.reference.path.segments();
}

/// Returns the distances along the segment at which the curvature may be largest or smallest. The
/// returned distances are both ends of the segment, and the vertex of the quadratic curvature if
/// the vertex lies inside the segment.
std::vector<double> Extrema(const Segment& segment) {
  std::vector<double> places{0.0, segment.length};
  const double vertex = -segment.sharpness / segment.sharpness_rate;
  // If the curvature is not quadratic, `vertex` is NaN or infinite and is not added.
  if (vertex > 0.0 && vertex < segment.length) {
    places.push_back(vertex);
  }
  return places;
}

double MaxCurvature(const Segments& segments) {
  double largest = 0.0;
  for (const Segment& segment : segments) {
    for (const double d : Extrema(segment)) {
      largest = std::max(largest, std::abs(segment.CurvatureAt(d)));
    }
  }
  return largest;
}

double MaxCurvatureRate(const Segments& segments) {
  // The curvature rate is linear within a segment, so its largest magnitude is at an end.
  double largest = 0.0;
  for (const Segment& segment : segments) {
    largest = std::max({largest, std::abs(segment.sharpness),
                        std::abs(segment.sharpness + segment.sharpness_rate * segment.length)});
  }
  return largest;
}

/// Computes the integral of the squared curvature by three-point Gauss-Legendre quadrature, which
/// is exact for the square of a quadratic.
double SquaredCurvature(const Segment& segment) {
  static const double kOuter = std::sqrt(0.6);
  const double half = 0.5 * segment.length;
  const auto square = [&](double u) {
    const double curvature = segment.CurvatureAt(half * (1.0 + u));
    return curvature * curvature;
  };
  return half * (5.0 * square(-kOuter) + 8.0 * square(0.0) + 5.0 * square(kOuter)) / 9.0;
}

/// Returns distances along the segment in ascending order: the distances of both ends, and the
/// distances at which the curvature is 0.
std::vector<double> Crossings(const Segment& segment) {
  std::vector<double> places{0.0, segment.length};
  const auto add = [&](double d) {
    if (d > 0.0 && d < segment.length) {  // skips a distance `d` that is NaN
      places.push_back(d);
    }
  };
  // Compute the distances d at which the curvature 0.5 r d^2 + q d + p is 0, with a formula that
  // avoids cancellation errors.
  const double p = segment.curvature;
  const double q = segment.sharpness;
  const double r = segment.sharpness_rate;
  const double root = std::sqrt(q * q - 2.0 * r * p);
  const double larger = -(q + std::copysign(root, q));
  add(larger / r);
  add(2.0 * p / larger);
  std::sort(places.begin(), places.end());
  return places;
}

double Turning(const Segments& segments) {
  double turned = 0.0;
  for (const Segment& segment : segments) {
    const auto heading = [&](double d) {
      return d *
             (segment.curvature + d * (0.5 * segment.sharpness + d * segment.sharpness_rate / 6.0));
    };
    const std::vector<double> places = Crossings(segment);
    for (std::size_t i = 1; i < places.size(); ++i) {
      turned += std::abs(heading(places[i]) - heading(places[i - 1]));
    }
  }
  return turned;
}

/// Returns the largest curvature jump of a path, except at cusps and stops, where SplitIntoLegs
/// cuts the path into legs.
double MaxCurvatureJump(const PlannedPath& path) {
  // Largest rounding error of the curvature at the end of a segment [rad/m]; smaller jumps count as
  // 0.
  constexpr double kRounding = 1e-12;
  double largest = 0.0;
  const Path& line = path.plan.reference.path;
  for (const Stations& leg : SplitIntoLegs(line, path.plan.stops)) {
    const Segments segments = line.Cut(leg);
    for (std::size_t i = 1; i < segments.size(); ++i) {
      const Segment& before = segments[i - 1];
      largest =
          std::max(largest, std::abs(segments[i].curvature - before.CurvatureAt(before.length)));
    }
  }
  return largest > kRounding ? largest : 0.0;
}

/// Computes the minimum clearance along the path. The length of each step along the path depends on
/// the clearance at the current station, because the clearance changes by at most `moved` meters
/// per meter of path.
std::optional<double> MinClearance(const PlannedPath& path) {
  World known = path.world;
  std::erase_if(known.obstacles, [](const Obstacle& obstacle) {
    return obstacle.moves() || obstacle.known_from_time || obstacle.known_from_range;
  });
  constexpr double kTolerance = 0.01;  // [m]
  const Path& line = path.plan.reference.path;
  const VehicleParams& vehicle = path.vehicle;
  const double reach = std::hypot(
      std::max(vehicle.rear_overhang, vehicle.length - vehicle.rear_overhang), 0.5 * vehicle.width);
  const double moved = 1.0 + MaxCurvature(line.segments()) * reach;
  std::optional<double> smallest;
  for (double s = 0.0;;) {
    const std::optional<double> here = Clearance(known, vehicle, line.At(s).pose, 0.0);
    if (!here) {
      return std::nullopt;
    }
    smallest = std::min(smallest.value_or(*here), *here);
    if (*smallest <= 0.0 || s >= line.length()) {
      return smallest;
    }
    s = std::min(line.length(), s + (*here - *smallest + kTolerance) / moved);
  }
}

}  // namespace

const std::vector<PathProperty>& PathProperties() {
  static const std::vector<PathProperty> properties{
      {"length_m", "Length of the plan", "m",
       [](const PlannedPath& path) -> std::optional<double> {
         return path.plan.reference.path.length();
       }},
      {"duration_s", "Duration of the plan", "s",
       [](const PlannedPath& path) -> std::optional<double> { return path.plan.Duration(); }},
      {"curvature_max_radpm", "Maximum curvature of the plan", "rad/m",
       [](const PlannedPath& path) -> std::optional<double> {
         return MaxCurvature(SegmentsOf(path));
       }},
      {"curvature_rms_radpm", "RMS curvature of the plan", "rad/m",
       [](const PlannedPath& path) -> std::optional<double> {
         double squares = 0.0;
         for (const Segment& segment : SegmentsOf(path)) {
           squares += SquaredCurvature(segment);
         }
         const double length = path.plan.reference.path.length();
         return length > 0.0 ? std::sqrt(squares / length) : 0.0;
       }},
      {"turning_rad", "Turning of the plan, both ways added", "rad",
       [](const PlannedPath& path) -> std::optional<double> { return Turning(SegmentsOf(path)); }},
      {"curvature_rate_max_radpm2", "Maximum curvature rate of the plan between jumps", "rad/m^2",
       [](const PlannedPath& path) -> std::optional<double> {
         return MaxCurvatureRate(SegmentsOf(path));
       }},
      {"curvature_jump_max_radpm", "Largest jump of the plan's curvature", "rad/m",
       [](const PlannedPath& path) -> std::optional<double> { return MaxCurvatureJump(path); }},
      {"clearance_min_m", "Minimum clearance of the plan", "m", MinClearance},
      {"waypoint_miss_max_m", "Largest distance of the plan from a waypoint", "m",
       [](const PlannedPath& path) -> std::optional<double> {
         const auto miss = LargestWaypointMiss(path.plan.reference.path, path.plan.waypoints);
         return miss ? std::optional(miss->distance) : std::nullopt;
       }},
  };
  return properties;
}

}  // namespace trackbed
