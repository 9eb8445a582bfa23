#pragma once

#include <vector>

namespace trackbed {

/// Lowers the squared speeds w [m^2/s^2] at stations [m] until |da/dt| <= `jerk` [m/s^3] between
/// adjacent intervals; a = dw/ds/2 is the acceleration in an interval.
///
/// With da/dt = v d^2w/ds^2/2 the limit is |w''| <= K(s) = 2 jerk/v. v is the speed before
/// lowering: lower speeds afterwards only allow a larger K. With G'' = K, the limit says that w - G
/// is concave and w + G convex:
///   1. w1 is the minimum of w and, for every station t with w'' > K, of the curve through w(t)
///      with w'' = K whose slope at t is the slope of w nearest to 0. Each curve ends where it
///      meets w.
///   2. w2 + G is the convex hull of w1 + G. This keeps the curvature of w1 where it is convex.
/// Speeds that keep the limit stay as they are. Only step 1 lowers the first and the last squared
/// speed.
/// Cost: O(n) plus the lengths of the curves, about 50 ns per station.
void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares);

/// Same as LimitJerk, for a lap whose last station is its first one.
void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares);

}  // namespace trackbed
