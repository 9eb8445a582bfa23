#pragma once

#include <vector>

namespace trackbed {

/// Lowers the squares w [m^2/s^2] of the speeds at stations [m] until |da/dt| <= `jerk` [m/s^3]
/// from each interval to the next, a = dw/ds/2 being the acceleration in an interval.
///
/// With da/dt = v d^2w/ds^2/2 the limit is |w''| <= K(s) = 2 jerk/v, for which the speeds before
/// count, as the lower ones after may change faster. With G'' = K it says that w - G is concave and
/// w + G convex:
///   1. w1 is the minimum of w and, for every station t at which w'' > K, of the curve through w(t)
///      that has w'' = K and at t the slope of w that is nearest to 0, as far as it is below w;
///   2. w2 + G is the convex hull of w1 + G, which keeps the curvature of w1 where it is convex.
/// Speeds that keep the limit stay as they are. The first and the last square are not lowered but
/// by 1. Cost: O(n) and the lengths of the curves, about 50 ns a station.
void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares);

/// The same of a lap whose last station is its first one.
void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares);

}  // namespace trackbed
