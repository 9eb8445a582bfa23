#include "trackbed/planning/curves/shortest_curve.h"

#include <cmath>

namespace trackbed {
namespace {

/// Largest length, in turning radii, of pieces that are dropped, because they are rounding errors
/// of a zero angle.
constexpr double kMinPieceLength = 1e-12;

bool IsThere(const CurvePiece& piece) {
  return std::abs(piece.sweep) > kMinPieceLength;
}

}  // namespace

std::string CurveWord(const ShortestCurve& curve) {
  std::string word;
  for (int i = 0; i < curve.count; ++i) {
    const CurvePiece& piece = curve.pieces[static_cast<std::size_t>(i)];
    if (IsThere(piece)) {
      word += piece.bend == Bend::kLeft ? 'L' : piece.bend == Bend::kRight ? 'R' : 'S';
      word += piece.sweep > 0.0 ? '+' : '-';
    }
  }
  return word;
}

std::vector<Segment> ToSegments(const ShortestCurve& curve) {
  std::vector<Segment> segments;
  for (int i = 0; i < curve.count; ++i) {
    const CurvePiece& piece = curve.pieces[static_cast<std::size_t>(i)];
    if (IsThere(piece)) {
      segments.push_back({.length = std::abs(piece.sweep) * curve.radius,
                          .curvature = static_cast<double>(piece.bend) / curve.radius,
                          .direction = piece.sweep > 0.0 ? 1 : -1});
    }
  }
  return segments;
}

}  // namespace trackbed
