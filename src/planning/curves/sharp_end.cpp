#include "src/planning/curves/sharp_end.h"

#include <algorithm>

#include "src/planning/curves/clothoid.h"

namespace trackbed {

SharpEnd::SharpEnd(const TurnCircle& circle, const CurveState& state, int order)
    : circle_(circle), state_(state.curvature), order_(order) {
  const double turned = 0.5 * state_ * state_ / circle.sharpness;
  neutral_ = state.pose.yaw + order * std::copysign(turned, state_);
  for (const int side : {-1, 1}) {
    // The clothoid from the state toward `side` has the curvature 0 at the point `zero`.
    Side& own = sides_[side < 0 ? 0 : 1];
    own.side = side;
    own.yaw = state.pose.yaw - order * side * turned;
    own.zero = state.pose.position();
    own.done = side * state_ / circle.sharpness;
    if (state_ == 0.0 && side > 0) {
      own.half = sides_[0].half;
      continue;
    }
    own.half = Direction(0.5 * own.yaw);
    if (state_ != 0.0) {
      const Vec2 done = ClothoidTo(side * state_, circle.sharpness);
      const Vec2 ahead = order * DoubleAngle(own.half);
      own.zero -= done.x() * ahead + done.y() * side * order * LeftNormal(ahead);
    }
  }
}

SharpEnd SharpEnd::Wound(int circles) const {
  SharpEnd wound = *this;
  const double turns = circles * 2.0 * kPi;
  wound.neutral_ += turns;
  for (Side& side : wound.sides_) {
    side.yaw += turns;
    side.half = circles == 0 ? side.half : Vec2(-side.half);
  }
  return wound;
}

CurvePiece SharpEnd::Piece(const Side& side, double alpha) const {
  const double a = Deflection(side, alpha);
  const bool is_small = a < 2.0 * circle_.least;
  const double peak = is_small ? std::sqrt(a * circle_.sharpness) : 1.0;
  return {.bend = side.side < 0 ? Bend::kRight : Bend::kLeft,
          .sweep = is_small ? 0.0 : a - 2.0 * circle_.least,
          .ramps = {.first = order_ > 0 ? state_ : 0.0,
                    .peak = side.side * std::min(peak, 1.0),
                    .last = order_ > 0 ? 0.0 : state_,
                    .sharpness = circle_.sharpness}};
}

}  // namespace trackbed
