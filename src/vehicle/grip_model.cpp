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
// their roll stiffness. The tyre model is the Magic Formula or a friction circle. The accelerations
// are feasible if the tyres of both axles can generate the required lateral force in addition to
// their longitudinal force. Bisection finds the largest feasible f_y at each f_x. Bisection also
// finds the limits of driving and braking at fractions cos(angle) of the largest f_y.
namespace trackbed {
namespace {

// Value that replaces the lateral force of an axle that cannot generate the required longitudinal
// force.
constexpr double kInfeasibleGrip = -1.0;

/// Returns the lateral force [N] of a tyre at a slip angle, while the tyre generates the
/// longitudinal force `along`. Returns none if the tyre cannot generate this longitudinal force at
/// any slip ratio.
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
  // Slip ratios on a road with the friction factor 1. On another road, the peak of the force is at
  // a slip ratio that is proportional to the road's factor.
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
  double along = 0.0;            // Longitudinal force that each wheel must generate [N].
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
};

AxleGripState OnFrictionCircles(double friction, const AxleDemand& demand) {
  AxleGripState state{.most = 0.0};
  for (const double load : demand.load) {
    const double most = friction * demand.road * load;
    if (std::abs(demand.along) > most) {
      return {};
    }
    state.most += std::sqrt(most * most - demand.along * demand.along);
  }
  return state;
}

AxleGripState FindGrip(const GripAxle& axle, const AxleDemand& demand, double wanted) {
  if (!axle.tyre) {
    return OnFrictionCircles(axle.friction, demand);
  }
  const auto lateral_at = [&](double angle) {
    double sum = 0.0;
    for (const double load : demand.load) {
      // A positive lateral force requires a negative slip angle.
      const std::optional<double> own = TyreLateral(*axle.tyre, load, demand.road, demand.along,
                                                    {.angle = -angle, .camber = demand.camber});
      if (!own) {
        return kInfeasibleGrip;
      }
      sum += *own;
    }
    return sum;
  };
  // Largest slip angle of the search [rad]. The angle of the peak is proportional to the road's
  // factor.
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
  return state;
}

/// Determines which accelerations f_x and f_y the car can hold in a steady state.
class SteadyState {
 public:
  SteadyState(const GripModel& car, double road, double speed)
      : car_(car),
        road_(road),
        drag_(car.forces.drag * speed * speed),
        weight_(car.forces.mass * kGravity) {
    roll_stiffness_ = car.axles[0].roll_stiffness + car.axles[1].roll_stiffness;
    lean_ = weight_ * car.cg_height;
  }

  /// Returns whether both axles can generate the forces that the accelerations require. The tyres
  /// must also overcome the drag due to their slip angles. The drag due to the slip angles depends
  /// on the tyre forces, so AxlesHold uses a fixed-point iteration.
  [[nodiscard]] bool AxlesHold(double longitudinal, double lateral) const {
    // Each iteration reduces the error of the drag to about a tenth.
    constexpr int kDragIterations = 4;
    double slip_drag = 0.0;  // [m/s^2]
    bool hold = true;
    for (int round = 0; round < kDragIterations; ++round) {
      double next = 0.0;
      hold = true;
      for (std::size_t i = 0; i < car_.axles.size(); ++i) {
        const AxleDemand demand = DemandOn(i, longitudinal, longitudinal + slip_drag, lateral);
        const double wanted = car_.forces.mass * lateral * car_.axles[i].weight;
        const AxleGripState state = FindGrip(car_.axles[i], demand, wanted);
        hold = hold && state.most >= wanted;
        next += lateral * car_.axles[i].weight * state.angle;
      }
      if (std::abs(next - slip_drag) < kSameDrag) {
        break;
      }
      slip_drag = next;
    }
    return hold;
  }

  [[nodiscard]] bool Holds(double longitudinal, double lateral) const {
    return lateral <= RollOver() && AxlesHold(longitudinal, lateral);
  }

  /// Returns the largest lateral acceleration f_y that the car can hold at the longitudinal
  /// acceleration f_x; 0 if the car can hold none.
  [[nodiscard]] double MaxLateral(double longitudinal) const {
    return Largest(0.0, kMaxAcceleration,
                   [&](double lateral) { return Holds(longitudinal, lateral); });
  }

  /// Starting at `from`, returns the last longitudinal acceleration f_x in the direction of `side`
  /// at which the car can hold the lateral acceleration f_y.
  [[nodiscard]] double Reach(double from, double side, double lateral) const {
    return from + side * Largest(0.0, kMaxAcceleration, [&](double further) {
                    return Holds(from + side * further, lateral);
                  });
  }

 private:
  // Upper bound of accelerations [m/s^2], which no car without downforce reaches.
  static constexpr double kMaxAcceleration = 40.0;
  // Change of the drag per mass at which the iteration ends [m/s^2].
  static constexpr double kSameDrag = 0.005;

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
    // Number of halvings, which yields a resolution of 40/2^16 = 0.0006 m/s^2.
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
  // The table needs only two speeds, because drag and the load transfer by drag are linear in the
  // squared speed.
  constexpr double kMaxTableSpeed = 60.0;  // [m/s]
  std::vector<double> speeds{0.0};
  if (car.forces.drag > 0.0 && car.drag_height != car.cg_height) {
    speeds.push_back(car.forces.top_speed > 0.0 ? std::min(car.forces.top_speed, kMaxTableSpeed)
                                                : kMaxTableSpeed);
  }
  std::vector<GgvSection> sections;
  for (const double road : roads) {
    for (const double speed : speeds) {
      sections.push_back(ComputeSection(car, road, speed));
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
  // If the mass is unknown, use 1 kg, because the accelerations do not depend on the mass.
  const double mass = vehicle.mass > 0.0 ? vehicle.mass : 1.0;
  return {{.mass = mass, .rolling_mass = mass, .top_speed = vehicle.top_speed},
          std::move(sections)};
}

}  // namespace trackbed
