// Replaces short arcs in curves of arc, straight and arc by gentler arcs.
//
// Let alpha be the heading of the straight, seen from the start pose. The arcs turn by the signed
// angles alpha and yaw - alpha; an arc can change its side as it becomes longer. The arcs and the
// straight form a curve if f(alpha) = 0, where f is the distance between the two arcs perpendicular
// to the straight. Let u be the length of the straight, g the ratio kGentleness, and l_1 and l_2
// the lengths of the arcs. The derivative of f(alpha) is f' = -(u + (1/4 - 1/(2 g)) (l_1 + l_2)).
// The straight must be at least as long as each steering ramp, l_1/g or l_2/g, and as (l_1 +
// l_2)/4. With g = 4 and this bound of u, each step alpha <- alpha + f/u of the iteration at least
// halves the error of alpha.
#include "trackbed/planning/curves/drivable_curve.h"

#include <algorithm>
#include <cmath>

#include "src/planning/curves/curve_goal.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/vehicle/steering_schedule.h"

namespace trackbed {
namespace {

/// Largest sweep that counts as a rounding error of a zero angle [rad], as in ToSegments.
constexpr double kNoTurn = 1e-12;

/// Ratio between the length of a gentler arc and the length of its ramps. With the length ratio g,
/// an arc and half of both ramps have the length (sqrt(g) + 1/sqrt(g)) S. S is the length of a ramp
/// for g = 1. The lateral offset due to curvature steps is proportional to g^(-3/2). An arc 4 times
/// as long as its ramps needs a quarter more room than an arc of equal length. Its curvature steps
/// cause an eighth of the offset. On a gentle arc, a controller has time to correct errors while
/// the wheels keep their angle.
constexpr double kGentleness = 4.0;

/// The length of a ramp from straight to `curvature` [m], at StepSpeed or at `speed` if lower.
double SharpRamp(const VehicleParams& vehicle, double curvature, double speed, double min_speed) {
  const double step = std::max(StepSpeed(vehicle, 0.0, curvature), min_speed);
  return std::abs(
      SteeringDistance(vehicle, SteeringForCurvature(vehicle, curvature), std::min(speed, step)));
}

/// One end of a word.
struct WordEnd {
  double sweep = 0.0;        // Angle of the arc [rad], positive to the left.
  double curvature = 0.0;    // Curvature of the arc [1/m].
  double beyond = 0.0;       // Curvature of the adjacent path outside the word [1/m].
  double start_speed = 0.0;  // Speed of a car that slows down before the arc [m/s].
  bool continues = false;    // Whether the arc continues an arc of the adjacent path.
  bool is_gentle = false;    // Whether the arc may get another radius.

  [[nodiscard]] bool IsShort() const { return is_gentle && std::abs(sweep) > kNoTurn; }
};

class GentleWord {
 public:
  GentleWord(const VehicleParams& vehicle, const Pose2& from, const Pose2& to,
             const ShortestCurve& word, const CurveDrive& drive)
      : vehicle_(vehicle),
        drive_(drive),
        direction_(word.pieces[1].sweep < 0.0 ? -1 : 1),
        first_(EndOf(word.pieces[0], drive.before)),
        last_(EndOf(word.pieces[2], drive.after)),
        goal_(from, to, 1.0) {
    first_.start_speed = drive.start_speed;
    goal_ = direction_ < 0 ? goal_.Reversed() : goal_;
  }

  [[nodiscard]] bool HasShortArc() const { return first_.IsShort() || last_.IsShort(); }

  /// Returns the speed at which the car can drive the curve's short arcs unchanged; 0 if the car
  /// must stop at these arcs.
  [[nodiscard]] double ShortestSpeed() const {
    double speed = drive_.speed;
    for (const WordEnd* end : {&first_, &last_}) {
      if (end->IsShort()) {
        const double length = std::abs(end->sweep) * drive_.radius;
        speed = std::min(speed, vehicle_.steering_rate * length /
                                    SteeringForCurvature(vehicle_, 1.0 / drive_.radius));
      }
    }
    return speed < drive_.min_speed ? 0.0 : speed;
  }

  /// Returns the pieces for a car at `speed`; no pieces if they do not fit between the poses.
  [[nodiscard]] std::vector<Segment> PiecesAt(double speed) const {
    double first_sweep = first_.sweep;
    double last_sweep = last_.sweep;
    constexpr int kTries = 100;  // more than 53 halvings
    for (int i = 0; i < kTries; ++i) {
      const Turn first = TurnAt(first_, first_sweep, speed);
      const Turn last = TurnAt(last_, last_sweep, speed);
      const double cos = std::cos(first_sweep);
      const double sin = std::sin(first_sweep);
      const double straight = goal_.x * cos + goal_.y * sin - first.Along() - last.Along();
      const double least =
          std::max({first.ramp, last.ramp, 0.25 * (first.Length() + last.Length())});
      if (straight < least || !first.Keeps(first_) || !last.Keeps(last_)) {
        return {};
      }
      const double across = goal_.y * cos - goal_.x * sin + first.Across() - last.Across();
      const double turn = across / straight;
      if (std::abs(turn) <= kNoTurn) {
        return Pieces(first, straight, last);
      }
      first_sweep += turn;
      last_sweep -= turn;
    }
    return {};
  }

 private:
  /// A turn at one end of the curve: an arc, and the straight between the arc and the curve's end.
  struct Turn {
    double sweep = 0.0;      // Angle of the arc [rad].
    double curvature = 0.0;  // Signed curvature of the arc [1/m]; 0 with a sweep of 0.
    double ramp = 0.0;       // Length of the ramp from straight to the arc [m].
    double outside = 0.0;    // Length of the straight between arc and end [m].

    [[nodiscard]] bool IsNothing() const { return std::abs(sweep) <= kNoTurn; }
    [[nodiscard]] double Length() const { return IsNothing() ? 0.0 : sweep / curvature; }
    /// Distance from the start to the end of the turn, parallel to the straight [m].
    [[nodiscard]] double Along() const {
      return outside * std::cos(sweep) + (IsNothing() ? 0.0 : std::sin(sweep) / curvature);
    }
    /// Distance from the start to the end of the turn, perpendicular to the straight [m].
    [[nodiscard]] double Across() const {
      const double half = std::sin(0.5 * sweep);
      return outside * std::sin(sweep) + (IsNothing() ? 0.0 : 2.0 * half * half / curvature);
    }
    /// Returns whether an arc whose radius must not change keeps its side and has room for its
    /// ramp; true for arcs whose radius may change.
    [[nodiscard]] bool Keeps(const WordEnd& end) const {
      return end.is_gentle || Length() >= (end.continues ? 0.0 : ramp);
    }
  };

  [[nodiscard]] WordEnd EndOf(const CurvePiece& piece, const PathBend& beyond) const {
    const double side = static_cast<double>(piece.bend);
    const double sweep = std::abs(piece.sweep);
    WordEnd end{.sweep = side * sweep, .curvature = side / drive_.radius};
    end.beyond = beyond.direction == direction_ ? beyond.curvature : 0.0;
    // An arc that continues the arc of the neighboring path piece never counts as short. At an end
    // without an arc, the curve may need a gentle arc, because a changed arc at the other end
    // rotates the straight.
    end.continues = end.beyond == end.curvature;
    const bool is_short =
        !end.continues && !HasRoomForRamps(vehicle_, sweep * drive_.radius, drive_);
    end.is_gentle = is_short || sweep <= kNoTurn;
    return end;
  }

  /// Returns the curvature of the sharpest arc that the car can drive at `speed` [1/m]. On the
  /// sharpest drivable arc, the tyres do not slide, and the curvature steps displace the car by at
  /// most kStepDeviation (see StepSpeed).
  [[nodiscard]] double SharpestAt(double speed) const {
    const double step = std::pow(
        vehicle_.steering_rate * std::sqrt(24.0 * kStepDeviation) / (vehicle_.wheelbase * speed),
        2.0 / 3.0);
    const double grip = MaxLateralAcceleration(vehicle_, drive_.road) / (speed * speed);
    return std::min({1.0 / drive_.radius, step, grip > 0.0 ? grip : step});
  }

  [[nodiscard]] Turn TurnAt(const WordEnd& end, double sweep, double speed) const {
    if (!end.is_gentle) {
      return {sweep, end.curvature, SharpRamp(vehicle_, end.curvature, speed, drive_.min_speed),
              0.0};
    }
    // Factor that enlarges the required lengths by a margin for rounding errors.
    constexpr double kMore = 1.0 + 1e-9;
    const double rolled = kMore * vehicle_.wheelbase * speed / vehicle_.steering_rate;  // S/kappa
    const double curvature =
        std::min(SharpestAt(speed), std::sqrt(std::abs(sweep) / (kGentleness * rolled)));
    const double ramp = rolled * curvature;
    const double beyond = SharpRamp(vehicle_, end.beyond, speed, drive_.min_speed);
    // The car slows down before the steering ramp, half of which lies outside the arc.
    const double excess = end.start_speed * end.start_speed - speed * speed;
    const double braking =
        excess > 0.0 ? 0.5 * excess / drive_.deceleration * kMore + 0.5 * ramp : 0.0;
    return {sweep, std::copysign(curvature, sweep), ramp, std::max({ramp, beyond, braking})};
  }

  [[nodiscard]] std::vector<Segment> Pieces(const Turn& first, double straight,
                                            const Turn& last) const {
    std::vector<Segment> pieces;
    for (const auto& [length, curvature] : {std::pair{first.outside, 0.0},
                                            {first.Length(), first.curvature},
                                            {straight, 0.0},
                                            {last.Length(), last.curvature},
                                            {last.outside, 0.0}}) {
      if (length > 0.0) {
        AppendPieces(pieces, {{.length = length, .curvature = curvature, .direction = direction_}});
      }
    }
    return pieces;
  }

  const VehicleParams& vehicle_;
  const CurveDrive& drive_;
  int direction_;
  WordEnd first_;
  WordEnd last_;
  CurveGoal goal_;  // Relative goal pose; mirrored for reverse [m].
};

/// Whether the curve is an arc, a straight and an arc, all in one direction.
bool IsArcStraightArc(const ShortestCurve& word) {
  if (word.count != 3 || word.pieces[1].bend != Bend::kNone) {
    return false;
  }
  const double direction = word.pieces[1].sweep < 0.0 ? -1.0 : 1.0;
  return std::all_of(word.pieces.begin(), word.pieces.begin() + 3,
                     [&](const CurvePiece& piece) { return direction * piece.sweep >= -kNoTurn; });
}

}  // namespace

bool HasRoomForRamps(const VehicleParams& vehicle, double length, const CurveDrive& drive) {
  return length >= SharpRamp(vehicle, 1.0 / drive.radius, drive.speed, drive.min_speed);
}

std::vector<Segment> DrivablePieces(const VehicleParams& vehicle, const Pose2& from,
                                    const Pose2& to, const ShortestCurve& word,
                                    const CurveDrive& drive) {
  if (!IsArcStraightArc(word)) {
    return ToSegments(word);
  }
  const GentleWord gentle(vehicle, from, to, word, drive);
  if (!gentle.HasShortArc()) {
    return ToSegments(word);
  }
  std::vector<Segment> pieces = gentle.PiecesAt(drive.speed);
  if (!pieces.empty()) {
    return pieces;
  }
  double slow = std::max(gentle.ShortestSpeed(), drive.min_speed);
  double fast = drive.speed;
  if (slow < fast) {
    pieces = gentle.PiecesAt(slow);
  }
  constexpr int kHalvings = 20;  // Bisection to a millionth of the speed.
  for (int i = 0; i < kHalvings && !pieces.empty(); ++i) {
    const double speed = 0.5 * (slow + fast);
    std::vector<Segment> faster = gentle.PiecesAt(speed);
    if (faster.empty()) {
      fast = speed;
    } else {
      slow = speed;
      pieces = std::move(faster);
    }
  }
  return pieces.empty() ? ToSegments(word) : pieces;
}

PathBend FirstBend(const VehicleParams& vehicle, const ShortestCurve& word,
                   const CurveDrive& drive) {
  const std::vector<Segment> pieces = ToSegments(word);
  if (pieces.empty()) {
    return {};
  }
  const bool is_long = HasRoomForRamps(vehicle, pieces.front().length, drive);
  return {is_long ? pieces.front().curvature : 0.0, pieces.front().direction};
}

void AppendPieces(std::vector<Segment>& path, const std::vector<Segment>& pieces) {
  for (const Segment& piece : pieces) {
    const auto is_arc = [](const Segment& segment) {
      return segment.sharpness == 0.0 && segment.sharpness_rate == 0.0;
    };
    if (!path.empty() && is_arc(path.back()) && is_arc(piece) &&
        path.back().curvature == piece.curvature && path.back().direction == piece.direction) {
      path.back().length += piece.length;
    } else {
      path.push_back(piece);
    }
  }
}

PathBend LastBend(const std::vector<Segment>& path) {
  if (path.empty()) {
    return {};
  }
  return {path.back().CurvatureAt(path.back().length), path.back().direction};
}

bool CanStartRolling(const PlanRequest& request, double curvature,
                     const std::vector<Segment>& pieces, double min_speed) {
  constexpr double kSame = 1e-6;  // [1/m]
  if (pieces.empty() || pieces.front().direction < 0 ||
      std::abs(pieces.front().curvature - curvature) >= kSame) {
    return false;
  }
  const double start = request.start_speed * request.start_speed;
  const auto can_slow_to = [&](double s, double speed) {
    return start - speed * speed <= 2.0 * request.speed.deceleration * s;
  };
  const StepSpeeds steps = PlanSteps(request.vehicle, pieces, min_speed);
  return std::all_of(steps.stops.begin(), steps.stops.end(),
                     [&](double s) { return can_slow_to(s, 0.0); }) &&
         std::all_of(steps.caps.begin(), steps.caps.end(), [&](const SpeedCap& cap) {
           return can_slow_to(cap.from, std::min(cap.speed, request.start_speed));
         });
}

}  // namespace trackbed
