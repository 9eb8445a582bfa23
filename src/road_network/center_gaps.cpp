#include "src/road_network/center_gaps.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

// Adds smooth moves w(s) C to a path p(s), where C is a constant vector in the plane and w a
// quintic polynomial that rises from 0 to 1. The first and second derivatives of the moved path p +
// w C determine its heading and curvature, so the moved path is as smooth as the path p.

namespace trackbed {
namespace {

/// A smooth displacement of the path by the vector `offset`, between the stations `from` and `from
/// + length`.
struct Move {
  double from = 0.0;
  double length = 0.0;
  Vec2 offset{0.0, 0.0};

  [[nodiscard]] double End() const { return from + length; }
};

/// The sum of all moves of the path at a station, and its derivatives with respect to the station.
struct MoveRate {
  Vec2 value{0.0, 0.0};
  Vec2 first{0.0, 0.0};
  Vec2 second{0.0, 0.0};
};

MoveRate RateAt(const std::vector<Move>& moves, double s) {
  MoveRate rate;
  for (const Move& move : moves) {
    const double q = std::clamp((s - move.from) / move.length, 0.0, 1.0);
    rate.value += q * q * q * (10.0 + q * (-15.0 + 6.0 * q)) * move.offset;
    if (q > 0.0 && q < 1.0) {
      rate.first += 30.0 * q * q * (1.0 - q) * (1.0 - q) / move.length * move.offset;
      rate.second +=
          60.0 * q * (1.0 - q) * (1.0 - 2.0 * q) / (move.length * move.length) * move.offset;
    }
  }
  return rate;
}

/// Returns the moves (smooth displacements) that bring the path back to the points of the lane
/// centers. The moves are ordered by the station of the point at which the path deviates.
std::vector<Move> NeededMoves(const Path& path, const std::vector<Piece>& runs) {
  std::vector<Move> moves;
  Vec2 moved(0.0, 0.0);
  for (const Piece& run : runs) {
    for (const CenterPoint& point : run) {
      const Vec2 off = path.At(point.curve.s).pose.position() + moved - point.position;
      if (off.norm() <= kKeptOffset) {
        continue;
      }
      const double length = std::min(ClosingLength(off.norm()), path.length());
      const double from = std::clamp(point.curve.s - 0.5 * length, 0.0, path.length() - length);
      moves.push_back({from, length, -off});
      moved -= off;
    }
  }
  return moves;
}

Vec2 TangentAt(double yaw) {
  return {std::cos(yaw), std::sin(yaw)};
}

/// Returns heading and curvature of the moved path at a point, and keeps the station of the point.
CurvePoint Moved(const CurvePoint& point, const MoveRate& rate) {
  const Vec2 tangent = TangentAt(point.yaw);
  const Vec2 first = tangent + rate.first;
  const Vec2 second = point.curvature * Vec2(-tangent.y(), tangent.x()) + rate.second;
  const double turn =
      std::atan2(tangent.x() * first.y() - tangent.y() * first.x(), tangent.dot(first));
  const double speed = first.norm();
  return {point.s, point.yaw + turn,
          (first.x() * second.y() - first.y() * second.x()) / (speed * speed * speed)};
}

}  // namespace

double ClosingLength(double offset) {
  constexpr double kCurvature = 1e-3;             // Largest curvature that a move adds to the path
                                                  // [1/m].
  const double steepest = 10.0 / std::sqrt(3.0);  // Largest second derivative of the blending
                                                  // polynomial w for a move of length 1.
  return std::sqrt(steepest * offset / kCurvature);
}

bool CloseGaps(const Path& path, std::vector<Piece>& runs) {
  const std::vector<Move> moves = NeededMoves(path, runs);
  if (moves.empty()) {
    return false;
  }
  // A move of the path overlaps only with moves at nearby stations. `active` contains the moves
  // near the current point.
  std::vector<Move> by_start = moves;
  std::stable_sort(by_start.begin(), by_start.end(),
                   [](const Move& a, const Move& b) { return a.from < b.from; });
  std::vector<Move> active;
  Vec2 done(0.0, 0.0);  // Sum of the offsets of all path moves that end before the current point.
  auto next = by_start.begin();
  double before = 0.0;
  double distance = 0.0;
  for (Piece& run : runs) {
    for (CenterPoint& point : run) {
      const double s = point.curve.s;
      for (; next != by_start.end() && next->from < s; ++next) {
        active.push_back(*next);
      }
      std::erase_if(active, [&](const Move& move) {
        const bool has_ended = move.End() <= before;
        done += has_ended ? move.offset : Vec2(0.0, 0.0);
        return has_ended;
      });
      distance +=
          active.empty() || s <= before
              ? s - before
              : boost::math::quadrature::gauss<double, 7>::integrate(
                    [&](double at) {
                      return (TangentAt(path.At(at).pose.yaw) + RateAt(active, at).first).norm();
                    },
                    before, s);
      before = s;
      const MoveRate rate = RateAt(active, s);
      point.position = path.At(s).pose.position() + done + rate.value;
      point.curve = Moved(point.curve, rate);
      point.curve.s = distance;
    }
  }
  return true;
}

}  // namespace trackbed
