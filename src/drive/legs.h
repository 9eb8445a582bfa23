#pragma once

#include <cmath>
#include <deque>
#include <limits>

#include "trackbed/planning/common/plan.h"
#include "trackbed/planning/common/planner.h"

/// Plans that stop on the way, to change direction or to turn the wheels, driven leg by leg.
namespace trackbed {

/// A plan cut at its cusps and stops: the stretches that are driven in one go each, at least one.
std::deque<Plan> InLegs(const Plan& plan);

/// +1 for a plan that begins forwards, -1 backwards.
int GearOf(const Plan& plan);

/// Holds a car at a cusp, or at a start on a bend, until its wheels have turned to where they are
/// to be; then it changes gear.
class Standing {
 public:
  void Begin() {
    goes_on_ = true;
    before_ = std::numeric_limits<double>::infinity();
  }

  /// Whether the wheels are still turning; once they rest, it is over.
  bool GoesOn(double steering) {
    constexpr double kResting = 1e-4;  // [rad] in a control period
    goes_on_ = goes_on_ && !(std::abs(steering - before_) < kResting);
    before_ = steering;
    return goes_on_;
  }

 private:
  bool goes_on_ = false;
  double before_ = 0.0;
};

}  // namespace trackbed
