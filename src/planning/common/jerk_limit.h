#pragma once

#include <vector>

namespace trackbed {

/// Lowers the squared speeds w [m^2/s^2] at stations [m] until |da/dt| <= `jerk` [m/s^3] between
/// adjacent intervals. The acceleration in an interval is a = dw/ds/2.
///
/// With da/dt = v d^2w/ds^2/2 the limit is |w''| <= K(s) = 2 jerk/v. The speed v is the speed
/// before lowering, because lower speeds only allow a larger K. With G'' = K, the limit holds where
/// w + G is convex and w - G is concave. LimitJerk makes w + G convex and w - G concave in two
/// steps. Step 1 computes w1, the minimum of w and of curves with w'' = K. For every station t with
/// w'' > K, a curve passes through w(t). The slope of the curve at t is the slope of w nearest to
/// 0. The curve through w(t) ends where it meets w. Step 2 computes w2, for which w2 + G is the
/// convex hull of w1 + G. The convex hull keeps the curvature of w1 where w1 is convex.
///
/// Speeds that keep the limit stay as they are. Only step 1 lowers the first and the last squared
/// speed. Cost: O(n) plus the lengths of the curves of step 1, about 50 ns per station.
void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares);

/// Same as LimitJerk, for a lap whose last station is the first station.
void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares);

}  // namespace trackbed
