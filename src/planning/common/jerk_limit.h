#pragma once

#include <vector>

namespace trackbed {

/// Lowers the squared speeds w [m^2/s^2] at stations [m] until |da/dt| <= `jerk` [m/s^3] between
/// adjacent intervals. The acceleration in an interval is a = dw/ds/2.
///
/// With da/dt = v d^2w/ds^2/2 the limit is |w''| <= K(s) = 2 jerk/v. The speed v is the speed
/// before lowering; a lower speed would only allow a larger K. With a function G that satisfies G''
/// = K, the limit holds where w + G is convex and w - G is concave. LimitJerk makes w + G convex
/// and w - G concave in two steps. Step 1 computes w1, the minimum of w and of curves with the
/// second derivative K. Such a curve passes through w(t) at every station t with w'' > K. The slope
/// of the curve at t is the value closest to 0 between the slopes of w before and after t. On both
/// sides, the curve ends where it meets w. Step 2 computes w2, for which w2 + G is the lower convex
/// hull of w1 + G. The hull does not raise the second derivative, so the limit of step 1 stays
/// satisfied.
///
/// Speeds that satisfy the limit stay unchanged. Step 2 never changes the first and the last
/// squared speed. Cost: O(n) plus the lengths of the curves of step 1, about 50 ns per station.
void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares);

/// As LimitJerk, for a closed lap whose last station is the same place as its first station.
void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares);

}  // namespace trackbed
