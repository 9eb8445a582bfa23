#include "trackbed/planning/curves/shortest_curve.h"

#include <cmath>

namespace trackbed {
namespace {

/// Largest length, in turning radii, of pieces that are dropped, because they are rounding errors
/// of a zero angle.
constexpr double kMinPieceLength = 1e-12;

/// A part of a piece with one direction of motion: a ramp, an arc or a straight, in units of r.
struct Part {
  double length = 0.0;
  double curvature = 0.0;
  double sharpness = 0.0;
  int direction = 1;
};

Part Ramp(double from, double to, const CurveRamps& ramps) {
  return {.length = ramps.sharpness > 0.0 ? std::abs(to - from) / ramps.sharpness : 0.0,
          .curvature = from,
          .sharpness = std::copysign(ramps.sharpness, to - from),
          .direction = ramps.direction};
}

std::array<Part, 3> PartsOf(const CurvePiece& piece) {
  const CurveRamps& ramps = piece.ramps;
  const double curvature = ramps.sharpness > 0.0 ? ramps.peak : static_cast<double>(piece.bend);
  return {Ramp(ramps.first, ramps.peak, ramps),
          Part{.length = std::abs(piece.sweep),
               .curvature = curvature,
               .direction = piece.sweep < 0.0 ? -1 : 1},
          Ramp(ramps.peak, ramps.last, ramps)};
}

/// Returns whether the length of a part, or its change of the curvature, exceeds rounding errors.
bool IsThere(const Part& part) {
  return part.length * std::max(1.0, std::abs(part.sharpness)) > kMinPieceLength;
}

}  // namespace

std::string CurveWord(const ShortestCurve& curve) {
  std::string word;
  for (int i = 0; i < curve.count; ++i) {
    const CurvePiece& piece = curve.pieces[static_cast<std::size_t>(i)];
    int direction = 0;
    for (const Part& part : PartsOf(piece)) {
      if (IsThere(part) && part.direction != direction) {
        direction = part.direction;
        word += piece.bend == Bend::kLeft ? 'L' : piece.bend == Bend::kRight ? 'R' : 'S';
        word += direction > 0 ? '+' : '-';
      }
    }
  }
  return word;
}

std::vector<Segment> ToSegments(const ShortestCurve& curve) {
  std::vector<Segment> segments;
  const double r = curve.radius;
  for (int i = 0; i < curve.count; ++i) {
    for (const Part& part : PartsOf(curve.pieces[static_cast<std::size_t>(i)])) {
      if (IsThere(part)) {
        segments.push_back({.length = part.length * r,
                            .curvature = part.curvature / r,
                            .direction = part.direction,
                            .sharpness = part.sharpness / (r * r)});
      }
    }
  }
  return segments;
}

}  // namespace trackbed
