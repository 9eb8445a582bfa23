#pragma once

#include "trackbed/options/key_visitor.h"

/// Keys that several controllers have.
namespace trackbed {

inline constexpr Range kAhead{.min = 0.01, .max = 1000.0};  ///< [m]
inline constexpr Key kAheadTime{"time", "s", "looks at least as far as the car drives in it"};

inline constexpr Range kWeight{.min = 1e-6, .max = 1e6};
inline constexpr Key kCrossTrackWeight{"cross_track", "1/m^2",
                                       "weight of the cross-track error; else by the wheelbase"};
inline constexpr Key kHeadingWeight{"heading", "1/rad^2", "weight of the heading error"};
inline constexpr Key kRateWeight{"steering_rate", "s^2/rad^2",
                                 "weight of the steering rate; else by the car's own"};

}  // namespace trackbed
