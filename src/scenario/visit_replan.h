#pragma once

#include <cmath>
#include <limits>

#include "src/scenario/visit_planners.h"
#include "trackbed/scenario/scenario.h"

/// The keys of `plan.replan`: what plans again while driving.
namespace trackbed {

template <typename Archive>
void Visit(Archive& a, FrenetWeights& weights) {
  a.Field({"k_dj", "s^5/m^2", "of lateral jerk"}, weights.k_dj, Need::kOptional, kNotNegative);
  a.Field({"k_d", "1/m^2", "of the offset at the end"}, weights.k_d, Need::kOptional, kNotNegative);
  a.Field({"k_dt", "1/s", "of time, laterally"}, weights.k_dt, Need::kOptional, kNotNegative);
  a.Field({"k_sj", "s^5/m^2", "of longitudinal jerk"}, weights.k_sj, Need::kOptional, kNotNegative);
  a.Field({"k_s", "1/m^2", "of the station missed"}, weights.k_s, Need::kOptional, kNotNegative);
  a.Field({"k_v", "s^2/m^2", "of the speed missed"}, weights.k_v, Need::kOptional, kNotNegative);
  a.Field({"k_st", "1/s", "of time, along the path"}, weights.k_st, Need::kOptional, kNotNegative);
  a.Field({"k_lat", "", "of all that is lateral"}, weights.k_lat, Need::kOptional, kNotNegative);
  a.Field({"k_lon", "", "of all that is along the path"}, weights.k_lon, Need::kOptional,
          kNotNegative);
  a.Field(
      {"derivative_order", "", "of the integrals: 3 is jerk (Werling et al. 2010), 2 acceleration"},
      weights.derivative_order, Need::kOptional, Range{.min = 2, .max = 3});
}

template <typename Archive>
void VisitLimits(Archive& a, FrenetLimits& limits) {
  a.Field({"max_lateral_acceleration", "m/s^2", "of a motion"}, limits.max_lateral_acceleration,
          Need::kOptional, kPositive);
  a.Field({"steering_rate_share", "", "of the car's steering rate that a motion may ask for"},
          limits.steering_rate_share, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  a.Field({"speed_tolerance", "", "by which a motion may be faster than the mission, as a share"},
          limits.speed_tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

inline constexpr Key kEndOffsets{"end_offsets", "m", "from the route, that are tried"};
inline constexpr Key kSpeedFactors{"speed_factors", "", "of the wanted speed, that are tried"};
inline constexpr Range kOffsetRange{.min = -100.0, .max = 100.0};
inline constexpr Range kFactorRange{.min = 0.0, .max = 1.0};

template <typename Archive>
void Visit(Archive& a, FrenetOptions& options) {
  a.Field({"end_times", "s", "durations that are tried"}, options.end_times, Need::kOptional,
          Range{.max = 60.0, .above = 0.0});
  a.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  a.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  a.Field({"station_offsets", "m", "from where to stop or to follow, that are tried"},
          options.station_offsets, Need::kOptional, kOffsetRange);
  a.Field({"horizon", "s", "until when a motion must stay clear if it goes on as it ends"},
          options.horizon, Need::kOptional, Range{.min = 0.0, .max = 60.0});
  static const EnumNames<LateralMotion> laterals{{LateralMotion::kAuto, "auto"},
                                                 {LateralMotion::kOverTime, "over_time"},
                                                 {LateralMotion::kOverStation, "over_station"}};
  a.Field({"lateral", "",
           "whether it moves aside over time, over the way, or over the way when that is slow"},
          options.lateral, Need::kOptional, laterals);
  a.Field({"low_speed", "m/s", "below which 'auto' moves aside over the way"}, options.low_speed,
          Need::kOptional, kNotNegative);
  VisitLimits(a, options.limits);
  a.Section({"weights", "", "of the cost"}, options.weights);
  a.Field({"budget", "", "motions checked at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e9});
}

template <typename Archive>
void Visit(Archive& a, LatticeOptions& options) {
  a.Field({"layers", "", "of the lattice"}, options.layers, Need::kOptional,
          Range{.min = 1, .max = 100});
  a.Field({"spacing", "m", "between its layers"}, options.spacing, Need::kOptional, kPositive);
  a.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  a.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  VisitLimits(a, options.limits);
  a.Section({"weights", "", "of the cost"}, options.weights);
  a.Field({"budget", "", "edges checked at most"}, options.budget, Need::kOptional,
          Range{.min = 0, .max = 1e9});
}

/// How far the road reaches; a side that is not given has no end.
template <typename Archive>
void VisitRoadSide(Archive& a, const Key& key, double& width) {
  std::optional<double> side;
  if (std::isfinite(width)) {
    side = width;
  }
  a.Field(key, side, kPositive);
  width = side.value_or(std::numeric_limits<double>::infinity());
}

template <typename Archive>
void Visit(Archive& a, RoadWidths& road) {
  VisitRoadSide(a, {"left", "m", "of the route; without it there is no end"}, road.left);
  VisitRoadSide(a, {"right", "m", "of the route; without it there is no end"}, road.right);
}

/// Planners that find a way round by themselves, set to go forwards.
inline const std::vector<PlannerEntry>& DetourPlanners() {
  static const std::vector<PlannerEntry> table = [] {
    std::vector<PlannerEntry> fit;
    for (PlannerEntry entry : Planners()) {
      if (auto* hybrid = std::get_if<HybridAStarOptions>(&entry.defaults)) {
        hybrid->reverse = false;
      }
      if (entry.keeps_clear && !MayGoBackwards(entry.defaults)) {
        fit.push_back(entry);
      }
    }
    return fit;
  }();
  return table;
}

template <typename Archive>
void Visit(Archive& a, DetourChoice& choice) {
  a.Field({"attempts", "", "of a random planner, each with a seed of its own"}, choice.attempts,
          Need::kOptional, Range{.min = 1, .max = 1000});
  a.Field({"collision_penalty", "m", "for a way that is blocked"},
          choice.comparator.collision_penalty, Need::kOptional, kNotNegative);
  a.Field({"wind_weight", "", "of the wind along the way, in meters for meters"},
          choice.wind_weight, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, ReplanOptions& options) {
  a.Field({"period", "s", "between two looks at what is known"}, options.period, Need::kOptional,
          Range{.min = 0.05, .max = 60.0});
  a.Field({"look_ahead", "s", "for which the way must be clear, or another is looked for"},
          options.settings.look_ahead, Need::kOptional, Range{.min = 1.0, .max = 60.0});
  a.Field(kOutlineDistance, options.settings.safe_distance, Need::kOptional, kNotNegative);
  a.Section({"road", "", "how far it reaches beside the route, for the outline"},
            options.settings.road);
  a.Field({"gap", "m", "from bumper to bumper, behind what is in the way"}, options.settings.gap,
          Need::kOptional, kNotNegative);
  a.Field({"time_gap", "s", "besides, behind what moves"}, options.settings.time_gap,
          Need::kOptional, kNotNegative);
  a.Method({"along", "", "how motions along the route are found"}, options.along, AlongMethods(),
           Need::kOptional, [](auto&) {});
  a.Method({"detour", "", "another way to the goal, when no motion along the route leads past"},
           options.detour, DetourPlanners(), Need::kOptional, [](auto&) {});
  a.Section({"comparator", "", "what decides for a detour, or against it"}, options.comparator);
  if (options.detour && !options.comparator) {
    options.comparator.emplace();
  }
}

}  // namespace trackbed
