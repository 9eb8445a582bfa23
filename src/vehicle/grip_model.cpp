#include "trackbed/vehicle/grip_model.h"

#include <algorithm>
#include <array>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "trackbed/core/error.h"

// Computes the g-g-v diagram of a two-axle car. For a longitudinal acceleration f_x and a lateral
// acceleration f_y, load transfer determines the four wheel loads. The load transfer due to f_x
// depends on the wheelbase. The load transfer due to f_y is divided between the axles according to
// their roll stiffness. The tyre model of the g-g-v diagram is the Magic Formula or a friction
// circle. The accelerations f_x and f_y are feasible if the tyres of both axles can generate the
// required lateral force in addition to their longitudinal force. Bisection finds the largest
// feasible f_y at each f_x. Bisection also finds the limits of driving and braking at lateral
// accelerations that are fractions cos(angle) of the largest f_y.
namespace trackbed {
namespace {

// Value that replaces the lateral force of an axle that cannot generate the required longitudinal
// force.
constexpr double kInfeasibleGrip = -1.0;

/// Returns the lateral force [N] of a tyre at a slip angle, while the tyre generates the
/// longitudinal force `along`. Returns nullopt if the tyre cannot generate this longitudinal force
/// at any slip ratio.
std::optional<double> TyreLateral(const MagicFormula& tyre, double load, double road, double along,
                                  TyreSlip slip) {
  if (!(load > 0.0)) {
    return along == 0.0 ? std::optional(0.0) : std::nullopt;
  }
  const double side = along < 0.0 ? -1.0 : 1.0;
  const auto at = [&](double ratio) {
    slip.ratio = side * ratio;
    return EvaluateTyreForce(tyre, load, road, slip);
  };
  double low = 0.0;
  TyreForce below = at(low);
  const double wanted = side * along;
  if (side * below.longitudinal >= wanted) {
    return below.lateral;
  }
  // Slip ratios of the table, for a road with the friction factor 1. The slip ratio at the peak of
  // the longitudinal force is proportional to the road's friction factor.
  constexpr std::array<double, 11> kRatios{0.01, 0.02, 0.03, 0.045, 0.06, 0.08,
                                           0.10, 0.13, 0.17, 0.23,  0.30};
  for (const double on_dry_road : kRatios) {
    const double high = road * on_dry_road;
    const TyreForce above = at(high);
    if (side * above.longitudinal >= wanted) {
      // Interpolate, because the longitudinal force is almost linear between adjacent slip ratios
      // of the table.
      const double span = side * (above.longitudinal - below.longitudinal);
      const double share = (wanted - side * below.longitudinal) / span;
      return at(std::lerp(low, high, share)).lateral;
    }
    low = high;
    below = above;
  }
  return std::nullopt;
}

/// Wheel loads of an axle, and the longitudinal forces that its tyres must generate.
struct AxleDemand {
  std::array<double, 2> load{};  // Vertical loads of the inner and the outer wheel [N].
  double along = 0.0;            // Longitudinal force that each wheel of the axle must generate
                                 // [N].
  double camber = 0.0;           // Camber angle [rad].
  double road = 1.0;
};

/// Lateral grip of an axle whose tyres also generate the required longitudinal force.
struct AxleGripState {
  // Largest lateral force of the axle [N]; kInfeasibleGrip if the axle cannot generate the required
  // longitudinal force.
  double most = kInfeasibleGrip;
  // Slip angle at the required lateral force or, if the axle cannot generate this force, at the
  // largest lateral force [rad].
  double angle = 0.0;
  // Lateral force of the axle's outer wheel minus that of its inner wheel at the slip angle `angle`
  // [N].
  double difference = 0.0;
};

AxleGripState OnFrictionCircles(double friction, const AxleDemand& demand) {
  AxleGripState state{.most = 0.0};
  for (const double load : demand.load) {
    const double most = friction * demand.road * load;
    if (std::abs(demand.along) > most) {
      return {};
    }
    const double across = std::sqrt(most * most - demand.along * demand.along);
    state.difference = across - state.most;
    state.most += across;
  }
  return state;
}

AxleGripState FindGrip(const GripAxle& axle, const AxleDemand& demand, double wanted) {
  if (!axle.tyre) {
    return OnFrictionCircles(axle.friction, demand);
  }
  const auto wheel_at = [&](double load, double angle) {
    // A positive lateral force requires a negative slip angle.
    return TyreLateral(*axle.tyre, load, demand.road, demand.along,
                       {.angle = -angle, .camber = demand.camber});
  };
  const auto lateral_at = [&](double angle) {
    double sum = 0.0;
    for (const double load : demand.load) {
      const std::optional<double> own = wheel_at(load, angle);
      if (!own) {
        return kInfeasibleGrip;
      }
      sum += *own;
    }
    return sum;
  };
  // Largest slip angle in the search for the peak of the lateral force [rad]. The slip angle at the
  // peak of the lateral force is proportional to the road's friction factor.
  const double max_slip = 0.5 * demand.road;
  // Number of correct bits of the slip angle; a few bits suffice, because the force is flat around
  // the peak.
  constexpr int kBits = 8;
  const auto [peak, negative] = boost::math::tools::brent_find_minima(
      [&](double at) { return -lateral_at(at); }, 0.0, max_slip, kBits);
  AxleGripState state{.most = std::max(-negative, lateral_at(0.0)), .angle = peak};
  constexpr int kHalvings = 8;
  double low = 0.0;
  for (int i = 0; i < kHalvings && wanted < state.most; ++i) {
    const double middle = 0.5 * (low + state.angle);
    (lateral_at(middle) < wanted ? low : state.angle) = middle;
  }
  state.difference = wheel_at(demand.load[1], state.angle).value_or(0.0) -
                     wheel_at(demand.load[0], state.angle).value_or(0.0);
  return state;
}

/// Whether the steering angle of the front wheels is neglected (kStraight).
enum class FrontWheels { kStraight, kSteered };

/// Determines which accelerations f_x and f_y the car can hold in a steady state.
class SteadyState {
 public:
  SteadyState(const GripModel& car, double road, double speed)
      : car_(car),
        road_(road),
        speed_(speed),
        drag_(car.forces.drag * speed * speed),
        weight_(car.forces.mass * kGravity) {
    roll_stiffness_ = car.axles[0].roll_stiffness + car.axles[1].roll_stiffness;
    lean_ = weight_ * car.cg_height;
  }

  /// Returns whether both axles can generate the forces that the accelerations require. The tyres
  /// must also overcome the drag due to their slip angles. Unless `wheels` is kStraight, the front
  /// wheels have the steering angle of the turn. Drag and yaw moment depend on the axles' slip
  /// angles, so AxlesHold finds the slip angles by fixed-point iteration.
  [[nodiscard]] bool AxlesHold(double longitudinal, double lateral, FrontWheels wheels) const {
    // Each fixed-point iteration reduces the error of the slip angles to about a tenth.
    constexpr int kIterations = 4;
    AxleLoads needed = StraightAhead(lateral);
    double slip_drag = 0.0;  // [m/s^2]
    bool hold = true;
    for (int round = 0; round < kIterations; ++round) {
      std::array<AxleGripState, 2> states;
      double along_front = 0.0;
      hold = true;
      for (std::size_t i = 0; i < states.size(); ++i) {
        const AxleDemand demand = DemandOn(i, longitudinal, longitudinal + slip_drag, lateral);
        along_front = i == 0 ? demand.along : along_front;
        states[i] = FindGrip(car_.axles[i], demand, needed[i]);
        hold = hold && states[i].most >= needed[i];
      }
      const double next = lateral * (car_.axles[0].weight * states[0].angle +
                                     car_.axles[1].weight * states[1].angle);
      const AxleLoads before = needed;
      if (wheels == FrontWheels::kSteered) {
        needed = InTheTurn(lateral, along_front, states);
      }
      if (std::abs(next - slip_drag) < kSameDrag &&
          std::abs(needed[0] - before[0]) < kSameDrag * car_.forces.mass) {
        break;
      }
      slip_drag = next;
    }
    return hold;
  }

  [[nodiscard]] bool Holds(double longitudinal, double lateral) const {
    return lateral <= RollOver() && AxlesHold(longitudinal, lateral, FrontWheels::kStraight);
  }

  /// Returns the largest lateral acceleration f_y that the car can hold at the longitudinal
  /// acceleration f_x; 0 if the car can hold none.
  [[nodiscard]] double MaxLateral(double longitudinal) const {
    return Largest(0.0, kMaxAcceleration,
                   [&](double lateral) { return Holds(longitudinal, lateral); });
  }

  /// Returns the largest lateral acceleration f_y, up to `most`, that the car can hold at the
  /// longitudinal acceleration f_x with steered front wheels.
  [[nodiscard]] double MaxLateralSteered(double longitudinal, double most) const {
    const auto holds = [&](double lateral) {
      return AxlesHold(longitudinal, lateral, FrontWheels::kSteered);
    };
    return holds(most) ? most : Largest(0.0, most, holds);
  }

  /// Returns the longitudinal acceleration f_x farthest from `from`, in the direction of `side`, at
  /// which the car can hold the lateral acceleration f_y.
  [[nodiscard]] double Reach(double from, double side, double lateral) const {
    return from + side * Largest(0.0, kMaxAcceleration, [&](double further) {
                    return Holds(from + side * further, lateral);
                  });
  }

 private:
  // Upper bound of the car's accelerations [m/s^2]; no car without downforce reaches this bound.
  static constexpr double kMaxAcceleration = 40.0;
  // Change of the drag and of the front axle's force, per mass of the car, below which the
  // fixed-point iteration ends [m/s^2].
  static constexpr double kSameDrag = 0.005;

  /// Lateral forces of the front and the rear axle, perpendicular to the wheel planes [N].
  using AxleLoads = std::array<double, 2>;

  /// Returns the lateral axle forces without a steering angle. Each axle carries the same fraction
  /// of the lateral force as of the weight.
  [[nodiscard]] AxleLoads StraightAhead(double lateral) const {
    const double force = car_.forces.mass * lateral;
    return {force * car_.axles[0].weight, force * car_.axles[1].weight};
  }

  /// Returns the lateral axle forces in a steady turn with the slip angles and force differences of
  /// `axles`. `along` is the longitudinal force of each front wheel [N].
  [[nodiscard]] AxleLoads InTheTurn(double lateral, double along,
                                    const std::array<AxleGripState, 2>& axles) const {
    const double steering = std::clamp(
        std::atan(car_.wheelbase * lateral / (speed_ * speed_)) + axles[0].angle - axles[1].angle,
        0.0, car_.steering_limit);
    // The outer front wheel exerts more lateral force than the inner one. At a steering angle, the
    // difference of the front wheel forces has a component along the car, whose moment turns the
    // car out of the bend.
    const double outwards =
        0.5 * axles[0].difference * std::sin(steering) * car_.axles[0].track / car_.wheelbase;
    const AxleLoads straight = StraightAhead(lateral);
    return {(straight[0] + outwards - 2.0 * along * std::sin(steering)) / std::cos(steering),
            straight[1] - outwards};
  }

  /// Returns the wheel loads and longitudinal forces of axle i. The argument `wheels` is the sum of
  /// the longitudinal tyre forces, divided by the car's mass [m/s^2].
  [[nodiscard]] AxleDemand DemandOn(std::size_t i, double longitudinal, double wheels,
                                    double lateral) const {
    const GripAxle& axle = car_.axles[i];
    const double mass = car_.forces.mass;
    const double pitch =
        (mass * longitudinal * car_.cg_height + drag_ * (car_.drag_height - car_.cg_height)) /
        car_.wheelbase;
    const double roll = mass * lateral * car_.cg_height / (roll_stiffness_ - lean_);
    const double load = std::max(0.0, weight_ * axle.weight + (i == 0 ? -pitch : pitch));
    const double shift = std::min(roll * axle.roll_stiffness / axle.track, 0.5 * load);
    return {.load = {0.5 * load - shift, 0.5 * load + shift},
            .along = 0.5 * mass * wheels * (wheels < 0.0 ? axle.braking : axle.driving),
            .camber = -roll * (1.0 + 0.5 * axle.suspension_share * axle.camber_gain * axle.track),
            .road = road_};
  }

  /// Finds, by bisection, the largest number in [low, high] for which `holds` is true; `holds` must
  /// also be true for all smaller numbers.
  template <typename Test>
  [[nodiscard]] static double Largest(double low, double high, const Test& holds) {
    // Number of halvings in the bisection, which yields a resolution of 40/2^16 = 0.0006 m/s^2.
    constexpr int kHalvings = 16;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? low : high) = middle;
    }
    return low;
  }

  /// Returns the lateral acceleration f_y at which the inner wheels of both axles lose their load.
  [[nodiscard]] double RollOver() const {
    double moment = 0.0;
    for (const GripAxle& axle : car_.axles) {
      moment += 0.5 * weight_ * axle.weight * axle.track;
    }
    return moment * (roll_stiffness_ - lean_) /
           (car_.forces.mass * car_.cg_height * roll_stiffness_);
  }

  const GripModel& car_;
  double road_;
  double speed_;           // Speed [m/s].
  double drag_;            // Aerodynamic drag [N].
  double weight_;          // Weight of the car [N].
  double roll_stiffness_;  // Sum of the roll stiffnesses of both axles [N m/rad].
  double lean_;            // Overturning moment m g h of gravity per roll angle [N m/rad].
};

GgvSection ComputeSection(const GripModel& car, double road, double speed) {
  constexpr std::size_t kSteps = 12;
  const SteadyState state(car, road, speed);
  const auto [best, negative] = boost::math::tools::brent_find_minima(
      [&](double longitudinal) { return -state.MaxLateral(longitudinal); }, -0.3 * kGravity * road,
      0.3 * kGravity * road, 8);
  GgvSection section;
  section.speed = speed;
  section.road = road;
  section.lateral = -negative;
  section.driving.push_back(best);
  section.braking.push_back(best);
  for (std::size_t i = 1; i <= kSteps; ++i) {
    const double angle = 0.5 * std::numbers::pi * static_cast<double>(i) / kSteps;
    const double lateral = i == kSteps ? 0.0 : section.lateral * std::cos(angle);
    section.driving.push_back(state.Reach(best, 1.0, lateral));
    section.braking.push_back(state.Reach(best, -1.0, lateral));
  }
  return section;
}

/// Returns the speeds at which a g-g-v diagram is tabulated (its sections) [m/s]. Sections are
/// interpolated linearly in the squared speed, because drag and its load transfer are linear in it.
/// The curvature of a turn is inversely proportional to the squared speed, so the squared speed
/// doubles from each section to the next. At the lowest speed of the diagram, a turn at the
/// steering limit needs 1 g; at lower speeds, no turn reaches the grip limit.
std::vector<double> TableSpeeds(const GripModel& car, double top) {
  std::vector<double> speeds;
  const double slowest = std::sqrt(kGravity * car.wheelbase / std::tan(car.steering_limit));
  for (double speed = slowest; speed < top / std::numbers::sqrt2; speed *= std::numbers::sqrt2) {
    speeds.push_back(speed);
  }
  speeds.push_back(top);
  return speeds;
}

std::vector<double> Interpolate(const std::vector<double>& from, const std::vector<double>& to,
                                double share) {
  std::vector<double> values;
  for (std::size_t i = 0; i < from.size(); ++i) {
    values.push_back(std::lerp(from[i], to[i], share));
  }
  return values;
}

/// Returns the sections of the g-g-v diagram of a car that steers. `slow` and `fast` are sections
/// without steering angle, at speed 0 and at the largest speed. The steering angle of the turn
/// reduces the largest lateral acceleration. At each fraction of the largest lateral acceleration,
/// the limits of driving and braking are those without steering angle.
std::vector<GgvSection> SteeredSections(const GripModel& car, const GgvSection& slow,
                                        const GgvSection& fast) {
  std::vector<GgvSection> sections;
  for (const double speed : TableSpeeds(car, fast.speed)) {
    const double share = speed * speed / (fast.speed * fast.speed);
    GgvSection section;
    section.speed = speed;
    section.road = slow.road;
    section.driving = Interpolate(slow.driving, fast.driving, share);
    section.braking = Interpolate(slow.braking, fast.braking, share);
    section.lateral = SteadyState(car, slow.road, speed)
                          .MaxLateralSteered(section.driving.front(),
                                             std::lerp(slow.lateral, fast.lateral, share));
    sections.push_back(std::move(section));
  }
  return sections;
}

void CheckModel(const GripModel& car, const std::vector<double>& roads) {
  double stiffness = 0.0;
  for (const GripAxle& axle : car.axles) {
    TRACKBED_REQUIRE(axle.weight > 0.0 && axle.track > 0.0 && axle.roll_stiffness > 0.0 &&
                         (axle.tyre || axle.friction > 0.0),
                     "ComputeGgv: an axle of weight {}, track {} m, roll stiffness {} N m/rad, "
                     "friction {}; must be above 0",
                     axle.weight, axle.track, axle.roll_stiffness, axle.friction);
    stiffness += axle.roll_stiffness;
  }
  TRACKBED_REQUIRE(car.forces.mass > 0.0 && car.wheelbase > 0.0 && car.cg_height > 0.0 &&
                       stiffness > car.forces.mass * kGravity * car.cg_height,
                   "ComputeGgv: mass {} kg, wheelbase {} m, center of gravity at {} m, roll "
                   "stiffness {} N m/rad; the car must stand",
                   car.forces.mass, car.wheelbase, car.cg_height, stiffness);
  TRACKBED_REQUIRE(!roads.empty(), "ComputeGgv: no {}", "road");
}

}  // namespace

double MaxLateralForce(const GripModel& car, double road, double longitudinal) {
  CheckModel(car, {road});
  return SteadyState(car, road, 0.0).MaxLateral(longitudinal);
}

GgvDiagram ComputeGgv(const GripModel& car, const std::vector<double>& roads) {
  CheckModel(car, roads);
  constexpr double kMaxTableSpeed = 60.0;  // [m/s]
  const double top =
      car.forces.top_speed > 0.0 ? std::min(car.forces.top_speed, kMaxTableSpeed) : kMaxTableSpeed;
  // Without steering angles, drag and the load transfer by drag are linear in the squared speed, so
  // two speeds suffice.
  const bool drags = car.forces.drag > 0.0 && car.drag_height != car.cg_height;
  std::vector<GgvSection> sections;
  for (const double road : roads) {
    GgvSection slow = ComputeSection(car, road, 0.0);
    GgvSection fast = slow;
    fast.speed = top;
    if (drags) {
      fast = ComputeSection(car, road, top);
    }
    if (car.steering_limit > 0.0) {
      for (GgvSection& section : SteeredSections(car, slow, fast)) {
        sections.push_back(std::move(section));
      }
      continue;
    }
    sections.push_back(std::move(slow));
    if (drags) {
      sections.push_back(std::move(fast));
    }
  }
  return {car.forces, std::move(sections)};
}

GgvDiagram FrictionGgv(const VehicleParams& vehicle, const std::vector<double>& roads) {
  std::vector<GgvSection> sections;
  for (const double road : roads) {
    const double driving = MaxAcceleration(vehicle, road);
    const double braking = MaxDeceleration(vehicle, road);
    const double lateral = MaxLateralAcceleration(vehicle, road);
    TRACKBED_REQUIRE(driving > 0.0 && braking > 0.0 && lateral > 0.0,
                     "FrictionGgv: on a road of {} the car accelerates with {}, brakes with {} and "
                     "turns with {} m/s^2; must be above 0",
                     road, driving, braking, lateral);
    sections.push_back(EllipticSection(driving, braking, lateral));
    sections.back().road = road;
  }
  // If the car's mass is unknown, use 1 kg, because the accelerations at the grip limit do not
  // depend on the mass.
  const double mass = vehicle.mass > 0.0 ? vehicle.mass : 1.0;
  return {{.mass = mass, .rolling_mass = mass, .top_speed = vehicle.top_speed},
          std::move(sections)};
}

}  // namespace trackbed
