#pragma once

#include "src/scenario/key_lister.h"
#include "src/scenario/yaml_reader.h"
#include "src/scenario/yaml_writer.h"
#include "trackbed/control/steering_controller.h"

/// The keys of the section `control`.
namespace trackbed {

inline constexpr Range kFrequency{.max = 100.0, .above = 0.0};  // [Hz]
inline constexpr Key kBegin{"at", "s", "when it begins"};

template <typename Archive>
void Visit(Archive&, ScheduleOptions&) {}

inline constexpr Range kAhead{.min = 0.01, .max = 1000.0};  // [m]
inline constexpr Key kAheadTime{"time", "s", "looks at least as far as the car drives in it"};

template <typename Archive>
void Visit(Archive& a, PreviewOptions& options) {
  a.Field({"distance", "m",
           "how far ahead of the rear axle the car aims, at least; else by car, speed and path"},
          options.distance, kAhead);
  a.Field(kAheadTime, options.time, Need::kOptional, kNotNegative);
  static const EnumNames<PreviewLaw> laws{{PreviewLaw::kLinear, "linear"},
                                          {PreviewLaw::kExactArc, "exact_arc"}};
  a.Field({"law", "",
           "from the angle to the point aimed at to steering: MacAdam's gain, or the circle "
           "through the point"},
          options.law, Need::kOptional, laws);
  a.Field({"slip", "", "whether to reckon with the tyres' slip"}, options.slip, Need::kOptional);
}

template <typename Archive>
void Visit(Archive& a, PreviewIntegralOptions& options) {
  a.Field({"distance", "m",
           "how far ahead of the rear axle the path is looked at, at least; else by car, speed and "
           "path"},
          options.distance, kAhead);
  a.Field(kAheadTime, options.time, Need::kOptional, kNotNegative);
  static const EnumNames<PreviewWeight> weights{{PreviewWeight::kUniform, "uniform"},
                                                {PreviewWeight::kNear, "near"}};
  a.Field(
      {"weight", "", "of the previewed way: all of it alike, or less and less toward its far end"},
      options.weight, Need::kOptional, weights);
  a.Field({"delay", "s", "the driver's, before the wanted angle takes effect"}, options.delay,
          Need::kOptional, Range{.min = 0.0, .max = 2.0});
}

template <typename Archive>
void Visit(Archive& a, PurePursuitOptions& options) {
  a.Field({"distance", "m",
           "how far ahead of the rear axle the car aims, at least; else by car, speed and path"},
          options.distance, kAhead);
  a.Field(kAheadTime, options.time, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, StanleyOptions& options) {
  a.Field({"gain", "1/s", "at which the front axle's offset shrinks; else by the steering rate"},
          options.gain, kPositive);
  a.Field({"softening", "m/s",
           "added to the speed, so that a slow car steers calmly; else by the car's size"},
          options.softening, kNotNegative);
}

inline constexpr Range kWeight{.min = 1e-6, .max = 1e6};
inline constexpr Key kCrossTrackWeight{"cross_track", "1/m^2",
                                       "weight of the cross-track error; else by the wheelbase"};
inline constexpr Key kHeadingWeight{"heading", "1/rad^2", "weight of the heading error"};
inline constexpr Key kRateWeight{"steering_rate", "s^2/rad^2",
                                 "weight of the steering rate; else by the car's own"};

template <typename Archive>
void Visit(Archive& a, LqrOptions& options) {
  a.Field(kCrossTrackWeight, options.cross_track, kWeight);
  a.Field(kHeadingWeight, options.heading, Need::kOptional, Range{.min = 0.0, .max = 1e6});
  a.Field(kRateWeight, options.steering_rate, kWeight);
  a.Field({"preview", "s", "how far ahead the path's curvature is looked at"}, options.preview,
          Need::kOptional, Range{.min = 0.0, .max = 20.0});
}

template <typename Archive>
void Visit(Archive& a, MpcOptions& options) {
  a.Field(kCrossTrackWeight, options.cross_track, kWeight);
  a.Field(kHeadingWeight, options.heading, Need::kOptional, Range{.min = 0.0, .max = 1e6});
  a.Field(kRateWeight, options.steering_rate, kWeight);
  a.Field({"horizon", "", "how many steps are planned"}, options.horizon, Need::kOptional,
          Range{.min = 1, .max = MpcOptions::kLongestHorizon});
  a.Field({"step", "s", "of the horizon; at least the control period"}, options.step,
          Need::kOptional, Range{.min = 1e-3, .max = 1.0});
}

template <typename Archive>
void Visit(Archive& a, DeviationWeights& weights) {
  a.Field({"position", "1/m^2", "of the squared distance from the wanted position"},
          weights.position, Need::kOptional, kNotNegative);
  a.Field({"heading", "1/rad^2", "of the squared heading error"}, weights.heading, Need::kOptional,
          kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, OptimalSteeringOptions& options) {
  static const EnumNames<Matching> matchings{{Matching::kArcLength, "arc_length"},
                                             {Matching::kTime, "time"}};
  a.Field({"matching", "",
           "the wanted pose: that of the path where the car is, or where it should be by now"},
          options.matching, Need::kOptional, matchings);
  a.Field({"horizon", "m",
           "how far ahead the wanted motion is predicted, at least; else by car, speed and path"},
          options.horizon, Range{.min = 0.1, .max = 1000.0});
  a.Field(kAheadTime, options.time, Need::kOptional, kNotNegative);
  a.Section({"search", "",
             "for the angle, at every update; evaluations 0: 60, or 600 of isres, "
             "esch and crs2"},
            options.search);
  a.Section({"weights", "", "of the deviation"}, options.weights);
  a.Field({"deviation_limit", "",
           "on the root of the weighted squares; up to it the plan's "
           "curvature is steered"},
          options.deviation_limit, Need::kOptional, kNotNegative);
  a.Field({"max_steering", "rad", "either way; else the car's"}, options.max_steering,
          Range{.max = 1.5, .above = 0.0});
}

template <typename Archive>
void Visit(Archive& a, ConstantSteeringOptions& options) {
  a.Field({"steering", "rad", "bicycle angle to hold, positive to the left"}, options.steering,
          Need::kRequired, kSteering);
}

template <typename Archive>
void Visit(Archive& a, StepSteeringOptions& options) {
  a.Field({"amplitude", "rad", "where the wheels are turned to, positive to the left"},
          options.amplitude, Need::kRequired, kSteering);
  a.Field({"rate", "rad/s", "at which they are; else as fast as the car can"}, options.rate,
          kPositive);
  a.Field(kBegin, options.at, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, RampSteeringOptions& options) {
  a.Field({"end", "rad", "where the wheels are turned to, positive to the left"}, options.end,
          Need::kRequired, kSteering);
  a.Field({"rate", "rad/s", "at which they are"}, options.rate, Need::kOptional, kPositive);
  a.Field(kBegin, options.at, Need::kOptional, kNotNegative);
}

inline constexpr Key kAmplitude{"amplitude", "rad", "of the sine; positive begins to the left"};

template <typename Archive>
void Visit(Archive& a, SineSteeringOptions& options) {
  a.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  a.Field({"frequency", "Hz", "of the sine"}, options.frequency, Need::kOptional, kFrequency);
  a.Field({"cycles", "", "how many"}, options.cycles, Need::kOptional, kPositive);
  a.Field(kBegin, options.at, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, SineWithDwellOptions& options) {
  a.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  a.Field({"frequency", "Hz", "of the sine"}, options.frequency, Need::kOptional, kFrequency);
  a.Field({"dwell", "s", "how long it stays at its second peak"}, options.dwell, Need::kOptional,
          kNotNegative);
  a.Field(kBegin, options.at, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, SweptSineOptions& options) {
  a.Field(kAmplitude, options.amplitude, Need::kRequired, kSteering);
  a.Field({"start_frequency", "Hz", "with which it begins"}, options.start_frequency,
          Need::kOptional, kFrequency);
  a.Field({"end_frequency", "Hz", "with which it ends"}, options.end_frequency, Need::kOptional,
          kFrequency);
  a.Field({"duration", "s", "how long it lasts"}, options.duration, Need::kOptional, kPositive);
  static const EnumNames<Sweep> sweeps{{Sweep::kLinear, "linear"},
                                       {Sweep::kExponential, "exponential"}};
  a.Field({"sweep", "",
           "how the frequency goes: as long at every frequency, or as long in every octave"},
          options.sweep, Need::kOptional, sweeps);
  a.Field(kBegin, options.at, Need::kOptional, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, RecordingColumns& columns) {
  a.Field({"time", "s", "when; else t_s"}, columns.time);
  a.Field({"distance", "m", "where; else s_m"}, columns.distance);
  a.Field({"steering", "rad", "the bicycle angle, positive to the left; else steering_rad"},
          columns.steering);
  a.Field({"speed", "m/s", "the speed to follow; else speed_mps if there is one"}, columns.speed);
  a.Field({"acceleration", "m/s^2",
           "the acceleration to follow instead; else acceleration_mps2 if there is one"},
          columns.acceleration);
}

template <typename Archive>
void Visit(Archive& a, PlaybackOptions& options) {
  a.Field({"file", "", "the recording, a CSV file with a header; relative to this file"},
          options.file, Need::kRequired);
  static const EnumNames<PlaybackAxis> axes{{PlaybackAxis::kTime, "time"},
                                            {PlaybackAxis::kDistance, "distance"}};
  a.Field({"by", "", "what its rows follow: the time, or the distance driven"}, options.by,
          Need::kOptional, axes);
  a.Section({"columns", "", "the names of its columns"}, options.columns);
}

template <typename Archive>
void Visit(Archive& a, Braking& braking) {
  a.Field(kBegin, braking.at, Need::kRequired, kNotNegative);
  a.Field({"deceleration", "m/s^2", "down to standstill; 0: the car coasts"}, braking.deceleration,
          Need::kRequired, kNotNegative);
}

template <typename Archive>
void Visit(Archive& a, SpeedControlOptions& options) {
  a.Field({"acceleration", "m/s^2", "largest wanted; also shapes the plan's speed"},
          options.acceleration, Need::kOptional, kPositive);
  a.Field({"deceleration", "m/s^2",
           "of the plan's speed; the controller brakes with up to twice as much"},
          options.deceleration, Need::kOptional, kPositive);
  a.Field({"gain", "1/s", "wanted acceleration per speed error"}, options.gain, Need::kOptional,
          kPositive);
  static const PairShape knot{"a knot [t, v]", "knots [t, v]", kNotNegative, kSpeedRange};
  a.Field({"over_time", "s, m/s",
           "the speed instead of the mission's, linear between knots and held after the last; "
           "limited by the car alone"},
          options.over_time.knots, Need::kOptional, knot);
  a.Section({"braking", "", "from a moment on, whatever else is asked"}, options.braking);
}

}  // namespace trackbed
