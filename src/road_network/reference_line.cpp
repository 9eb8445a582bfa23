#include "trackbed/road_network/reference_line.h"

#include <algorithm>
#include <array>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using Coefficients = std::array<double, 4>;

double Value(const Coefficients& c, double p) {
  return c[0] + p * (c[1] + p * (c[2] + p * c[3]));
}

double First(const Coefficients& c, double p) {
  return c[1] + p * (2.0 * c[2] + p * 3.0 * c[3]);
}

double Second(const Coefficients& c, double p) {
  return 2.0 * c[2] + 6.0 * c[3] * p;
}

/// Number of parts into which the parameter range of a curve is divided to compute its length.
/// With this number of parts, a quadrature with ten nodes integrates the parameter speed of a
/// road's curve over each part to machine precision.
constexpr std::size_t kParts = 32;

/// Returns the index of the piece of a piecewise function that contains the station s. If the
/// station s lies before the first piece, returns the index of the first piece.
template <typename Piece>
std::size_t IndexAt(const std::vector<Piece>& pieces, double s) {
  const auto after = std::upper_bound(pieces.begin(), pieces.end(), s,
                                      [](double at, const Piece& piece) { return at < piece.s; });
  return after == pieces.begin() ? 0 : static_cast<std::size_t>(after - pieces.begin()) - 1;
}

}  // namespace

PiecewiseCubic::PiecewiseCubic(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  for (std::size_t i = 1; i < pieces_.size(); ++i) {
    TRACKBED_CHECK(pieces_[i - 1].s <= pieces_[i].s, "pieces at {} and {} m", pieces_[i - 1].s,
                   pieces_[i].s);
  }
}

CubicValue PiecewiseCubic::At(double s, double piece_of) const {
  if (pieces_.empty() || piece_of < pieces_.front().s) {
    return {};
  }
  const Piece& piece = pieces_[IndexAt(pieces_, piece_of)];
  const double d = s - piece.s;
  return {Value(piece.coefficients, d), First(piece.coefficients, d),
          Second(piece.coefficients, d)};
}

ParametricCubic::ParametricCubic(const Coefficients& u, const Coefficients& v, double p_end,
                                 double length)
    : u_(u), v_(v), p_end_(p_end), length_(length) {
  using Quadrature = boost::math::quadrature::gauss<double, 10>;
  lengths_.push_back(0.0);
  for (std::size_t i = 0; i < kParts; ++i) {
    const double part = p_end_ / static_cast<double>(kParts);
    const double from = part * static_cast<double>(i);
    lengths_.push_back(lengths_.back() + Quadrature::integrate([&](double p) { return Speed(p); },
                                                               from, from + part));
  }
  TRACKBED_CHECK(std::isfinite(arc_length()) && arc_length() > 0.0 && length_ > 0.0,
                 "a curve of {} m for {} m", arc_length(), length_);
}

ParametricCubic ParametricCubic::OverU(const Coefficients& v, double length) {
  // A curve v(u) is at least as long as its interval of u, so the parameter u at the end of the
  // curve is at most `length`.
  const Coefficients u{0.0, 1.0, 0.0, 0.0};
  const ParametricCubic whole(u, v, length, length);
  const double end = whole.Parameter(length);
  TRACKBED_CHECK(end > 0.0, "a curve that ends at u = {} m", end);
  return {u, v, end, length};
}

double ParametricCubic::Speed(double p) const {
  return std::hypot(First(u_, p), First(v_, p));
}

double ParametricCubic::Parameter(double arc) const {
  const auto after = std::upper_bound(lengths_.begin(), lengths_.end() - 1, arc);
  const std::size_t index =
      after == lengths_.begin() ? 0 : static_cast<std::size_t>(after - lengths_.begin()) - 1;
  const std::size_t part = std::min(index, kParts - 1);
  const double step = p_end_ / static_cast<double>(kParts);
  const double from = step * static_cast<double>(part);
  const double wanted = arc - lengths_[part];
  const double all = lengths_[part + 1] - lengths_[part];
  if (wanted <= 0.0) {
    return from;
  }
  if (wanted >= all) {
    return from + step;
  }
  const auto excess = [&](double p) {
    using Quadrature = boost::math::quadrature::gauss<double, 10>;
    return Quadrature::integrate([&](double q) { return Speed(q); }, from, p) - wanted;
  };
  std::uintmax_t most = 60;
  const auto [low, high] =
      boost::math::tools::toms748_solve(excess, from, from + step, -wanted, all - wanted,
                                        boost::math::tools::eps_tolerance<double>(50), most);
  return 0.5 * (low + high);
}

ParametricCubic::Point ParametricCubic::At(double distance) const {
  const double p = Parameter(std::clamp(distance / length_, 0.0, 1.0) * arc_length());
  const Vec2 first(First(u_, p), First(v_, p));
  const Vec2 second(Second(u_, p), Second(v_, p));
  const Vec2 third(6.0 * u_[3], 6.0 * v_[3]);
  const double speed = first.norm();
  Point point{.position = {Value(u_, p), Value(v_, p)},
              .heading = std::atan2(first.y(), first.x())};
  if (speed > 0.0) {
    const double cubed = speed * speed * speed;
    point.curvature = Cross(first, second) / cubed;
    point.sharpness = (Cross(first, third) / cubed -
                       3.0 * point.curvature * first.dot(second) / (speed * speed)) /
                      speed;
  }
  return point;
}

ReferenceLine::ReferenceLine(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  TRACKBED_CHECK(!pieces_.empty(), "a reference line without pieces");
  for (std::size_t i = 1; i < pieces_.size(); ++i) {
    TRACKBED_CHECK(pieces_[i - 1].s < pieces_[i].s, "pieces at {} and {} m", pieces_[i - 1].s,
                   pieces_[i].s);
  }
}

ReferenceLinePoint ReferenceLine::At(double s, double piece_of) const {
  TRACKBED_CHECK(!pieces_.empty(), "a reference line without pieces");
  const Piece& piece = pieces_[IndexAt(pieces_, piece_of)];
  const double distance = std::clamp(s - piece.s, 0.0, piece.length);
  if (const Path* path = std::get_if<Path>(&piece.curve)) {
    const PathPoint at = path->At(distance);
    return {at.pose, at.curvature, at.sharpness, 1.0};
  }
  const auto& curve = std::get<ParametricCubic>(piece.curve);
  const ParametricCubic::Point at = curve.At(distance);
  const Vec2 position = ToWorld(piece.start, at.position);
  return {{position.x(), position.y(), piece.start.yaw + at.heading},
          at.curvature,
          at.sharpness,
          curve.arc_length() / piece.length};
}

}  // namespace trackbed
