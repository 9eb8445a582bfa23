#pragma once

#include <vector>

namespace trackbed {

/// Lowers the squared speeds w [m^2/s^2] at stations [m] until |da/dt| <= `jerk` [m/s^3] between
/// adjacent intervals. In an interval, the derivative of the squared speed w gives the acceleration
/// a = dw/ds/2.
///
/// With da/dt = v d^2w/ds^2/2, the jerk limit for the squared speed w(s) is |w''| <= K(s) = 2
/// jerk/v. LimitJerk computes the bound K = 2 jerk/v from the speed v before lowering, which is
/// safe because a lower speed only increases K. Let G be a function with G'' = K. The squared
/// speeds w satisfy the jerk limit if w + G is convex and w - G is concave. LimitJerk makes w + G
/// convex and w - G concave in two steps. Step 1 lowers the squared speed w to w1. Through w(t) at
/// each station t with w'' > K, step 1 draws a curve with the second derivative K. The squared
/// speed w1 is the minimum of w and all curves of step 1. At its station t, a curve of step 1 has
/// the slope that is closest to 0 among all values between the slopes of w just before and just
/// after t. On each side of its station, a curve of step 1 extends to the point where it meets the
/// squared speed w. Step 2 lowers the squared speed w1 to w2, such that w2 + G is the lower convex
/// hull of w1 + G. The convex hull of step 2 does not raise the second derivative of w1, so the
/// upper bound w'' <= K from step 1 still holds.
///
/// Speeds that already satisfy the jerk limit stay unchanged. Step 2 never changes the first and
/// the last squared speed. The computing time is O(n) plus the total length of the curves in step
/// 1, about 50 ns per station.
void LimitJerk(const std::vector<double>& stations, double jerk, std::vector<double>& squares);

/// Performs LimitJerk for a closed lap, whose last station is at the same place as the first
/// station.
void LimitJerkAround(const std::vector<double>& stations, double jerk,
                     std::vector<double>& squares);

}  // namespace trackbed
