#include "src/planning/curves/faster_route.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

#include "src/planning/curves/fastest_leg.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/driving_time.h"
#include "trackbed/planning/common/feasibility.h"
#include "trackbed/planning/common/fewer_corners.h"
#include "trackbed/planning/common/route.h"
#include "trackbed/planning/common/waypoint_miss.h"

// Makes the sections of a route faster.
// 1. A section is a part of the route in one direction between two waypoints or cusps. For each
//    section, FasterLegs::Find searches a faster path with the same poses and speeds at both ends.
// 2. Take() replaces all these sections at once, and computes the speed profile of the whole route.
// 3. If a replaced section is not faster, Take() tries the faster sections and the others apart. If
//    all sections are faster in a plan that the car cannot drive, or that passes too far from
//    waypoints that it leaves out, Take() tries each half of the sections. Most routes need a few
//    speed profiles, whatever the number of sections.
namespace trackbed {
namespace {

/// Number of parts of equal driving time of a leg; ends of segments add further parts.
constexpr double kParts = 8.0;

/// Smallest relative gain in driving time for which a leg is changed.
constexpr double kLeastGain = 0.01;

/// A part of the route in one direction between two waypoints or cusps.
struct Section {
  std::vector<Segment> segments;
  std::size_t leg = 0;
  bool is_faster = false;  // whether the section is faster than in the given plan

  [[nodiscard]] double Length() const {
    double length = 0.0;
    for (const Segment& segment : segments) {
      length += segment.length;
    }
    return length;
  }
};

/// The times along a speed profile, as SpeedProfile computes them, but found by binary search.
class ProfileTimes {
 public:
  explicit ProfileTimes(const SpeedProfile& profile) : knots_(profile.knots()) {
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      times_.push_back(times_.back() + Duration(i, knots_[i + 1].s, knots_[i + 1].speed));
    }
  }

  /// Returns the time at which the car passes a station within the profile [s].
  [[nodiscard]] double TimeAt(const SpeedProfile& profile, double s) const {
    const auto after = std::lower_bound(
        knots_.begin(), knots_.end(), s,
        [](const SpeedProfile::Knot& knot, double value) { return knot.s < value; });
    const auto i = static_cast<std::size_t>(after - knots_.begin());
    if (i == 0 || i == knots_.size() || knots_[i].s == s) {
      return times_[std::min(i, times_.size() - 1)];
    }
    return times_[i - 1] + Duration(i - 1, s, profile.SpeedAt(s));
  }

  /// Returns the station that the car passes at a time [m]. Between two knots at rest, the duration
  /// is infinite, and the car stays at the first of both.
  [[nodiscard]] double StationAt(double time) const {
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    const auto i = static_cast<std::size_t>(after - times_.begin());
    if (i == 0 || i == times_.size()) {
      return i == 0 ? 0.0 : knots_.back().s;
    }
    const SpeedProfile::Knot& a = knots_[i - 1];
    const SpeedProfile::Knot& b = knots_[i];
    const double duration = Duration(i - 1, b.s, b.speed);
    const double left = time - times_[i - 1];
    return a.s + left * (a.speed + 0.5 * left * (b.speed - a.speed) / duration);
  }

 private:
  /// Returns the time from a knot to a station before the next knot, passed at `speed` [s].
  [[nodiscard]] double Duration(std::size_t knot, double s, double speed) const {
    return 2.0 * (s - knots_[knot].s) / (knots_[knot].speed + speed);
  }

  const std::vector<SpeedProfile::Knot>& knots_;
  std::vector<double> times_{0.0};
};

/// Stations and times at the ends of the sections of a plan.
class SectionEnds {
 public:
  SectionEnds(const Plan& plan, const std::vector<Section>& sections) : stations_{0.0} {
    for (const Section& section : sections) {
      stations_.push_back(stations_.back() + section.Length());
    }
    const SpeedProfile& profile = plan.reference.speed;
    const ProfileTimes times(profile);
    for (const double station : stations_) {
      times_.push_back(times.TimeAt(profile, std::min(station, plan.reference.path.length())));
    }
  }

  /// Returns the station at the start of a section [m].
  [[nodiscard]] double Start(std::size_t section) const { return stations_[section]; }
  /// Returns the driving time of a section [s].
  [[nodiscard]] double Duration(std::size_t section) const {
    return times_[section + 1] - times_[section];
  }

 private:
  std::vector<double> stations_;
  std::vector<double> times_;
};

class RouteRefiner {
 public:
  RouteRefiner(const ContinuousRoute& route, const PlanRequest& request, Plan plan,
               FasterLegs& legs)
      : route_(route),
        request_(request),
        legs_(legs),
        clear_(request.vehicle, request.obstacles, route.safe_distance),
        best_(std::move(plan)),
        limits_(LimitsOfMotion(route, request)) {}

  [[nodiscard]] Plan Make() {
    sections_ = SectionsOf(best_);
    const SectionEnds ends(best_, sections_);
    const ProfileTimes times(best_.reference.speed);
    std::vector<Section> faster = sections_;
    std::vector<std::size_t> changed;
    for (std::size_t i = 0; i < sections_.size(); ++i) {
      if (std::optional<std::vector<Segment>> found = Faster(i, ends, times)) {
        faster[i].segments = *std::move(found);
        faster[i].is_faster = true;
        changed.push_back(i);
      }
    }
    Take(faster, changed);
    return std::move(best_);
  }

 private:
  [[nodiscard]] static std::vector<Section> SectionsOf(const Plan& plan) {
    const auto& curves = plan.diagnostics.planner.GetIf<CurveDiagnostics>()->curves;
    std::vector<Section> sections;
    double left = 0.0;  // of the leg [m]
    std::size_t leg = 0;
    for (const Segment& segment : plan.reference.path.segments()) {
      constexpr double kLengthRounding = 1e-9;
      const bool is_next = left <= kLengthRounding * (1.0 + plan.reference.path.length());
      if (is_next) {
        leg = sections.empty() ? 0 : leg + 1;
        left = curves.at(leg).length;
      }
      if (is_next || sections.back().segments.back().direction != segment.direction) {
        sections.emplace_back().leg = leg;
      }
      sections.back().segments.push_back(segment);
      left -= segment.length;
    }
    return sections;
  }

  /// Replaces sections of the best plan by the faster ones, if each of them becomes faster, the
  /// path passes all waypoints, and the car can drive the plan. Otherwise tries the sections that
  /// become faster and the other sections apart. If all sections become faster in a plan that is
  /// not taken, tries each half.
  void Take(const std::vector<Section>& faster, std::span<const std::size_t> changed) {
    if (changed.empty()) {
      return;
    }
    std::vector<Section> sections = sections_;
    for (const std::size_t i : changed) {
      sections[i] = faster[i];
    }
    Plan plan = PlanOf(sections);
    const std::vector<std::size_t> gaining = Gaining(plan, sections, changed);
    const bool all_gain = changed.size() == 1 || gaining.size() == changed.size();
    if (plan.ok() && all_gain && IsFaster(plan, changed) && PassesWaypoints(plan) &&
        IsFeasible(plan)) {
      best_ = std::move(plan);
      sections_ = std::move(sections);
    } else if (!gaining.empty() && !all_gain) {
      std::vector<std::size_t> others;
      std::set_difference(changed.begin(), changed.end(), gaining.begin(), gaining.end(),
                          std::back_inserter(others));
      Take(faster, gaining);
      Take(faster, others);
    } else if (changed.size() > 1 && (all_gain || !plan.ok())) {
      Take(faster, changed.first(changed.size() / 2));
      Take(faster, changed.subspan(changed.size() / 2));
    }
  }

  /// Returns those of the changed sections that take less time in `plan` than in the best plan.
  [[nodiscard]] std::vector<std::size_t> Gaining(const Plan& plan,
                                                 const std::vector<Section>& sections,
                                                 std::span<const std::size_t> changed) const {
    std::vector<std::size_t> gaining;
    if (plan.ok()) {
      const SectionEnds before(best_, sections_);
      const SectionEnds after(plan, sections);
      std::copy_if(changed.begin(), changed.end(), std::back_inserter(gaining), [&](std::size_t i) {
        return after.Duration(i) < (1.0 - kLeastGain) * before.Duration(i);
      });
    }
    return gaining;
  }

  /// Returns whether a plan takes less time than the best plan.
  [[nodiscard]] bool IsFaster(const Plan& plan, std::span<const std::size_t> changed) const {
    const SectionEnds before(best_, sections_);
    double least = 0.0;
    for (const std::size_t i : changed) {
      least += kLeastGain * before.Duration(i);
    }
    return DrivingTime(plan, request_.vehicle) < DrivingTime(best_, request_.vehicle) - least;
  }

  /// Returns whether a plan passes the waypoints that its legs leave out within a quarter of the
  /// car's width.
  [[nodiscard]] bool PassesWaypoints(const Plan& plan) const {
    const auto& curves = plan.diagnostics.planner.GetIf<CurveDiagnostics>()->curves;
    if (curves.size() + 1 == request_.waypoints.size()) {
      return true;  // each leg ends at its waypoint
    }
    const auto miss = LargestWaypointMiss(plan.reference.path, request_.waypoints);
    return !miss || miss->distance <= kUnnoticedShareOfWidth * request_.vehicle.width;
  }

  /// Returns whether the car can drive a plan at its speeds.
  [[nodiscard]] bool IsFeasible(const Plan& plan) const {
    PlanRequest strict = request_;
    strict.infeasible = InfeasiblePolicy::kRefuse;
    return MakeFeasible(plan, strict).ok();
  }

  /// Returns a faster course of a section that is free of obstacles.
  [[nodiscard]] std::optional<std::vector<Segment>> Faster(std::size_t section,
                                                           const SectionEnds& ends,
                                                           const ProfileTimes& times) {
    const Section& own = sections_[section];
    const SpeedProfile& profile = best_.reference.speed;
    const double from = ends.Start(section);
    const double length = own.Length();
    FastestLeg leg{.start = own.segments,
                   .curvature = 1.0 / route_.radius,
                   .min_speed = std::max(route_.min_speed, kCrawlingSpeed),
                   .held_speed = kCrawlingSpeed,
                   .limits = limits_};
    leg.speeds.push_back(profile.SpeedAt(from));
    const double duration = ends.Duration(section);
    const double chord = Path({}, own.segments).At(length).pose.position().norm();
    const double least = LegTime(limits_, {{chord, limits_.speed.speed}}, leg.speeds.front(),
                                 profile.SpeedAt(from + length));
    // No path is faster than the straight line. Skip the search if even the straight line would
    // gain little.
    if (!std::isfinite(duration) || duration <= least * (1.0 + kLeastGain)) {
      return std::nullopt;
    }
    const auto time_at = [&](double s) {
      return times.TimeAt(profile, std::min(s, best_.reference.path.length()));
    };
    double station = from;
    for (const Segment& segment : own.segments) {
      const double start = time_at(station);
      const double end = time_at(station + segment.length);
      // Round with a tolerance, so that equal segments get equally many parts.
      constexpr double kShareRounding = 1e-3;
      const double parts =
          std::clamp(std::ceil(kParts * (end - start) / duration - kShareRounding), 1.0, kParts);
      double done = 0.0;
      for (double part = 1.0; part <= parts; part += 1.0) {
        const double to =
            part == parts
                ? segment.length
                : std::clamp(times.StationAt(start + (end - start) * part / parts) - station, done,
                             segment.length);
        leg.lengths.push_back(to - done);
        leg.speeds.push_back(profile.SpeedAt(station + to));
        done = to;
      }
      station += segment.length;
    }
    // A leg may crawl where its turns have no room at the lowest speed of the route.
    for (std::size_t i = 1; i + 1 < leg.speeds.size(); ++i) {
      leg.min_speed = std::clamp(leg.speeds[i], kCrawlingSpeed, leg.min_speed);
    }
    // A rolling car may start too fast for the mission or for its bend; it then slows down first.
    const double first = leg.speeds.front();
    const bool is_slow =
        *std::max_element(leg.speeds.begin(), leg.speeds.end()) <=
            request_.speed.speed * (1.0 + 1e-9) &&
        first * first * std::abs(own.segments.front().curvature) <= limits_.lateral * (1.0 + 1e-9);
    const bool has_gentle_ends =
        std::all_of(own.segments.begin(), own.segments.end(), [&](const Segment& segment) {
          return std::abs(segment.curvature) <= leg.curvature * (1.0 + 1e-9);
        });
    if (!is_slow || !has_gentle_ends) {
      return std::nullopt;
    }
    std::optional<std::vector<Segment>> found = legs_.Find(leg);
    if (found && !route::IsFree(clear_, best_.reference.path.At(from).pose, *found)) {
      found.reset();
    }
    return found;
  }

  [[nodiscard]] Plan PlanOf(const std::vector<Section>& sections) const {
    Plan plan = best_;
    plan.caps.clear();
    plan.schedule_speed = {};  // the schedule of the given plan fits only the given path
    CurveDiagnostics diagnostics = *best_.diagnostics.planner.GetIf<CurveDiagnostics>();
    std::vector<Segment> segments;
    const SectionEnds ends(best_, sections_);
    double station = 0.0;
    for (std::size_t i = 0; i < sections.size(); ++i) {
      const Section& section = sections[i];
      const double length = section.Length();
      if (section.is_faster) {
        for (const LegPiece& piece : LegPieces(limits_, section.segments, 0.0, 1)) {
          plan.caps.push_back({station, station + piece.length, piece.speed});
          station += piece.length;
        }
      } else {
        const double before = ends.Start(i);
        for (SpeedCap cap : best_.caps) {
          const double middle = 0.5 * (cap.from + cap.to);
          if (middle > before && middle < before + length) {
            cap.from += station - before;
            cap.to += station - before;
            plan.caps.push_back(cap);
          }
        }
        station += length;
      }
      diagnostics.curves.at(section.leg).length += length - sections_[i].Length();
      segments.insert(segments.end(), section.segments.begin(), section.segments.end());
    }
    plan.diagnostics.planner = std::move(diagnostics);
    plan.reference.path = Path(request_.start, std::move(segments));
    route::Complete(plan, request_);
    return plan;
  }

  const ContinuousRoute& route_;
  const PlanRequest& request_;
  FasterLegs& legs_;
  CollisionChecker clear_;
  Plan best_;
  LegLimits limits_;
  std::vector<Section> sections_;
};

/// Returns whether the curvature is continuous, except at cusps, within rounding.
bool IsContinuous(const Path& path) {
  constexpr double kSameCurvature = 1e-9;  // [1/m]
  const std::vector<Segment>& segments = path.segments();
  return std::adjacent_find(
             segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
               return a.direction == b.direction &&
                      std::abs(a.CurvatureAt(a.length) - b.curvature) > kSameCurvature;
             }) == segments.end();
}

}  // namespace

Plan FasterRoute(const ContinuousRoute& route, const PlanRequest& request, Plan plan,
                 FasterLegs& legs) {
  const bool can_be_faster = plan.ok() && route.objective == CurveObjective::kTime &&
                             !request.limits && plan.stops.empty() &&
                             IsContinuous(plan.reference.path) &&
                             !plan.reference.path.segments().empty();
  return can_be_faster ? RouteRefiner(route, request, std::move(plan), legs).Make() : plan;
}

}  // namespace trackbed
