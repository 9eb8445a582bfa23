#include "src/planning/curves/leg_speeds.h"

#include <algorithm>
#include <cmath>

namespace trackbed {
namespace {

/// Returns the largest speed on a stretch with the curvatures `from` to `to` at the rate
/// `sharpness`.
double MostSpeed(const LegLimits& limits, double from, double to, double sharpness) {
  const double most = std::max(std::abs(from), std::abs(to));
  const double least = from * to < 0.0 ? 0.0 : std::min(std::abs(from), std::abs(to));
  double speed = limits.speed.speed;
  if (most > 0.0) {
    speed = std::min(speed, std::sqrt(limits.lateral / most));
  }
  if (sharpness != 0.0) {
    const double bend = limits.wheelbase * least;
    speed = std::min(speed, limits.steering_rate * (1.0 + bend * bend) /
                                (limits.wheelbase * std::abs(sharpness)));
  }
  return speed;
}

/// Returns the driving time over a length, from one speed to another, with a peak speed of at most
/// `most` [s].
double PieceTime(const SpeedLimits& limits, double length, double from, double to, double most) {
  // The car accelerates at a to the peak speed p and brakes at d: (p^2 - from^2)/(2 a) + (p^2 -
  // to^2)/(2 d) = length.
  const double a = limits.acceleration;
  const double d = limits.deceleration;
  const double square = (2.0 * a * d * length + d * from * from + a * to * to) / (a + d);
  const double peak = std::clamp(std::sqrt(square), std::max(from, to), std::max(most, from));
  const double used = 0.5 * ((peak * peak - from * from) / a + (peak * peak - to * to) / d);
  const double rest = std::max(length - used, 0.0);
  return (peak - from) / a + (peak - to) / d + (peak > 0.0 ? rest / peak : 0.0);
}

}  // namespace

double SharpestCurvature(const std::vector<Segment>& segments) {
  double sharpest = 0.0;
  for (const Segment& segment : segments) {
    sharpest = std::max(
        {sharpest, std::abs(segment.curvature), std::abs(segment.CurvatureAt(segment.length))});
  }
  return sharpest;
}

std::vector<LegPiece> LegPieces(const LegLimits& limits, const std::vector<Segment>& segments,
                                double least, int parts) {
  const double lower = std::min(least, limits.speed.speed);
  std::vector<LegPiece> pieces;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    const int count = segment.sharpness == 0.0 ? 1 : parts;
    for (int k = 0; k < count; ++k) {
      const double from = segment.CurvatureAt(segment.length * k / count);
      const double to = segment.CurvatureAt(segment.length * (k + 1) / count);
      const double speed = MostSpeed(limits, from, to, segment.sharpness);
      pieces.push_back({segment.length / count, std::max(speed, lower),
                        k == 0 && i > 0 && segments[i - 1].direction != segment.direction});
    }
  }
  return pieces;
}

double LeastLegTime(const LegLimits& limits, const std::vector<Segment>& segments, double least) {
  double time = 0.0;
  for (const Segment& segment : segments) {
    // The fastest place is the end with the smaller curvature for the lateral acceleration, and the
    // end with the larger curvature for the steering rate.
    const double from = segment.curvature;
    const double to = segment.CurvatureAt(segment.length);
    const double low = from * to < 0.0 ? 0.0 : std::min(std::abs(from), std::abs(to));
    double speed = limits.speed.speed;
    if (low > 0.0) {
      speed = std::min(speed, std::sqrt(limits.lateral / low));
    }
    if (segment.sharpness != 0.0) {
      const double bend = limits.wheelbase * std::max(std::abs(from), std::abs(to));
      speed = std::min(speed, limits.steering_rate * (1.0 + bend * bend) /
                                  (limits.wheelbase * std::abs(segment.sharpness)));
    }
    time += segment.length / std::max(speed, std::min(least, limits.speed.speed));
  }
  return time;
}

double LegTime(const LegLimits& limits, const std::vector<LegPiece>& pieces, double start,
               double end) {
  // Speeds between pieces: a backward pass applies the speed limits and braking, then a forward
  // pass applies acceleration.
  std::vector<double> speeds(pieces.size() + 1, end);
  for (std::size_t i = pieces.size(); i-- > 0;) {
    const double braking = std::sqrt(speeds[i + 1] * speeds[i + 1] +
                                     2.0 * limits.speed.deceleration * pieces[i].length);
    const double before = i == 0 ? start : pieces[i - 1].speed;
    speeds[i] = pieces[i].stops ? 0.0 : std::min({braking, before, pieces[i].speed});
  }
  double time = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double faster =
        std::sqrt(speeds[i] * speeds[i] + 2.0 * limits.speed.acceleration * pieces[i].length);
    speeds[i + 1] = std::min(speeds[i + 1], faster);
    time += PieceTime(limits.speed, pieces[i].length, speeds[i], speeds[i + 1], pieces[i].speed);
  }
  return time;
}

}  // namespace trackbed
