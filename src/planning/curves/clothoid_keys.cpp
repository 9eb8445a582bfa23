#include "src/planning/curves/clothoid_keys.h"

namespace trackbed {

const EnumNames<CurveCurvature>& CurvaturesWithCusps() {
  static const EnumNames<CurveCurvature> names{{CurveCurvature::kAuto, "auto"},
                                               {CurveCurvature::kSteps, "steps"},
                                               {CurveCurvature::kContinuous, "continuous"},
                                               {CurveCurvature::kCuspSteps, "cusp_steps"}};
  return names;
}

void VisitClothoids(KeyVisitor& keys, double& max_lateral_acceleration,
                    double& max_steering_rate_fraction) {
  keys.Field({"max_lateral_acceleration", "m/s^2", "maximum lateral acceleration with clothoids"},
             max_lateral_acceleration, Need::kOptional, kPositive);
  keys.Field({"max_steering_rate_fraction", "",
              "maximum fraction of the car's steering rate that clothoids may use"},
             max_steering_rate_fraction, Need::kOptional, Range{.max = 1.0, .above = 0.0});
}

}  // namespace trackbed
