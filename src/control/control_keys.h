#pragma once

#include "trackbed/options/key_visitor.h"

/// Option keys that several controllers share.
namespace trackbed {

inline constexpr Range kAhead{.min = 0.01, .max = 1000.0};  ///< [m]
inline constexpr Key kAheadTime{"time", "s",
                                "minimum preview time: looks ahead at least speed times this"};

inline constexpr Key kBegin{"at", "s", "start time"};

inline constexpr Range kWeight{.min = 1e-6, .max = 1e6};
inline constexpr Key kCrossTrackWeight{
    "cross_track", "1/m^2", "weight of the cross-track error; default: from the wheelbase"};
inline constexpr Key kHeadingWeight{"heading", "1/rad^2", "weight of the heading error"};
inline constexpr Key kRateWeight{"steering_rate", "s^2/rad^2",
                                 "weight of the steering rate; default: from the car's limit"};

}  // namespace trackbed
