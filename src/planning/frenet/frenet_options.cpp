#include "trackbed/planning/frenet/frenet_options.h"

/// Option keys of the planners of motions along a path.
namespace trackbed {
namespace {

constexpr Key kEndOffsets{"end_offsets", "m", "candidate lateral offsets from the route"};
constexpr Key kSpeedFactors{"speed_factors", "", "candidate fractions of the target speed"};
constexpr Range kOffsetRange{.min = -100.0, .max = 100.0};
constexpr Range kFactorRange{.min = 0.0, .max = 1.0};

void VisitLimits(KeyVisitor& keys, FrenetLimits& limits) {
  keys.Field({"max_lateral_acceleration", "m/s^2", "maximum lateral acceleration"},
             limits.max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"max_steering_rate_fraction", "",
              "maximum fraction of the car's steering rate that a motion may use"},
             limits.max_steering_rate_fraction, Need::kOptional, Range{.max = 1.0, .above = 0.0});
  keys.Field({"speed_tolerance", "", "fraction by which a motion may exceed the mission speed"},
             limits.speed_tolerance, Need::kOptional, Range{.min = 0.0, .max = 1.0});
}

}  // namespace

void Visit(KeyVisitor& keys, FrenetWeights& weights) {
  keys.Field({"k_dj", "s^5/m^2", "weight of the lateral jerk"}, weights.k_dj, Need::kOptional,
             kNonNegative);
  keys.Field({"k_d", "1/m^2", "weight of the final lateral offset"}, weights.k_d, Need::kOptional,
             kNonNegative);
  keys.Field({"k_dt", "1/s", "weight of the time, lateral"}, weights.k_dt, Need::kOptional,
             kNonNegative);
  keys.Field({"k_sj", "s^5/m^2", "weight of the longitudinal jerk"}, weights.k_sj, Need::kOptional,
             kNonNegative);
  keys.Field({"k_s", "1/m^2", "weight of the final station error"}, weights.k_s, Need::kOptional,
             kNonNegative);
  keys.Field({"k_v", "s^2/m^2", "weight of the final speed error"}, weights.k_v, Need::kOptional,
             kNonNegative);
  keys.Field({"k_st", "1/s", "weight of the time, longitudinal"}, weights.k_st, Need::kOptional,
             kNonNegative);
  keys.Field({"k_lat", "", "weight of the lateral cost"}, weights.k_lat, Need::kOptional,
             kNonNegative);
  keys.Field({"k_lon", "", "weight of the longitudinal cost"}, weights.k_lon, Need::kOptional,
             kNonNegative);
  keys.Field({"derivative_order", "",
              "derivative in the cost integrals: 3 jerk (Werling et al. 2010), 2 acceleration"},
             weights.derivative_order, Need::kOptional, Range{.min = 2, .max = 3});
}

void Visit(KeyVisitor& keys, FrenetOptions& options) {
  keys.Field({"end_times", "s", "candidate durations"}, options.end_times, Need::kOptional,
             Range{.max = 60.0, .above = 0.0});
  keys.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  keys.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  keys.Field({"station_offsets", "m", "candidate station offsets when stopping or following"},
             options.station_offsets, Need::kOptional, kOffsetRange);
  keys.Field(
      {"horizon", "s", "time until which a motion, extrapolated past its end, must stay clear"},
      options.horizon, Need::kOptional, Range{.min = 0.0, .max = 60.0});
  static const EnumNames<LateralMotion> laterals{{LateralMotion::kAuto, "auto"},
                                                 {LateralMotion::kOverTime, "over_time"},
                                                 {LateralMotion::kOverStation, "over_station"}};
  keys.Field({"lateral", "",
              "lateral motion as a function of time, of station, or of station at low speed"},
             options.lateral, Need::kOptional, laterals);
  keys.Field({"low_speed", "m/s", "speed below which 'auto' uses the station"}, options.low_speed,
             Need::kOptional, kNonNegative);
  VisitLimits(keys, options.limits);
  keys.Section({"weights", "", "weights of the cost"}, options.weights);
  keys.Field({"budget", "", "maximum number of motions checked"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e9});
}

void Visit(KeyVisitor& keys, LatticeOptions& options) {
  keys.Field({"layers", "", "number of layers"}, options.layers, Need::kOptional,
             Range{.min = 1, .max = 100});
  keys.Field({"spacing", "m", "distance between layers"}, options.spacing, Need::kOptional,
             kPositive);
  keys.Field(kEndOffsets, options.end_offsets, Need::kOptional, kOffsetRange);
  keys.Field(kSpeedFactors, options.speed_factors, Need::kOptional, kFactorRange);
  VisitLimits(keys, options.limits);
  keys.Section({"weights", "", "weights of the cost"}, options.weights);
  keys.Field({"budget", "", "maximum number of edges checked"}, options.budget, Need::kOptional,
             Range{.min = 0, .max = 1e9});
}

}  // namespace trackbed
