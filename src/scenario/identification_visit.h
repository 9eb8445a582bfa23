#pragma once

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/identification.h"
#include "trackbed/sim/plant.h"

/// Functions Visit that declare the keys of an identification file.
namespace trackbed {

inline void Visit(KeyVisitor& a, ParameterPrior& prior) {
  a.Field({"mean", "", "in the parameter's unit"}, prior.mean, Need::kRequired);
  a.Field({"deviation", "", "standard deviation, in the parameter's unit"}, prior.deviation,
          Need::kRequired, kPositive);
}

inline void Visit(KeyVisitor& a, IdentifiedParameter& parameter) {
  a.Field({"name", "",
           "of a number under <custom> in the model, such as p_ky1_front or steering_curve[1]; or "
           "mass, cg_to_rear, cg_height, yaw_inertia, steering_rate, steering_limit, drive_torque, "
           "steering_offset"},
          parameter.name, Need::kRequired);
  a.Field({"from", "", "lower bound, in the parameter's unit"}, parameter.from, Need::kRequired);
  a.Field({"to", "", "upper bound, in the parameter's unit"}, parameter.to, Need::kRequired);
  a.Field({"start", "", "where the search begins; default: the model's value"}, parameter.start);
  a.Section({"prior", "", "normal distribution of the parameter before the fit"}, parameter.prior);
}

inline void Visit(KeyVisitor& a, ResidualDeviations& residuals) {
  a.Field({"yaw_rate", "rad/s", "standard deviation expected of the yaw rate's residuals"},
          residuals.yaw_rate, kPositive);
  a.Field({"lateral_acceleration", "m/s^2",
           "standard deviation expected of the residuals at the center of gravity"},
          residuals.lateral_acceleration, kPositive);
  a.Field({"lateral_speed", "m/s", "standard deviation expected of the residuals"},
          residuals.lateral_speed, kPositive);
  a.Field({"position", "m", "standard deviation expected of the residuals along each axis"},
          residuals.position, kPositive);
  a.Field({"heading", "rad", "standard deviation expected of the residuals"}, residuals.heading,
          kPositive);
  a.Field({"speed", "m/s", "standard deviation expected of the residuals"}, residuals.speed,
          kPositive);
}

inline void Visit(KeyVisitor& a, BankEstimation& bank) {
  a.Field(
      {"track", "", "track file; default: the path of the first fitted record, or its first lap"},
      bank.track);
  a.Field({"spacing", "m", "distance of the knots of the bank; default: an eighth of its length"},
          bank.spacing, kPositive);
  a.Field({"deviation", "rad", "standard deviation of the bank before the fit, about 0"},
          bank.deviation, Need::kOptional, kPositive);
  a.Field({"largest", "rad", "bound of the bank to either side"}, bank.largest, Need::kOptional,
          Range{.max = 0.7, .above = 0.0});
}

inline void Visit(KeyVisitor& a, Identification& study) {
  int schema = 1;
  a.Field({"schema", "", "version of this format"}, schema, Need::kRequired,
          Range{.min = 1.0, .max = 1.0});
  a.Identifier({"name", "", "name of the identification"}, study.name);
  Names plants;
  for (const PlantEntry& entry : Plants()) {
    plants.emplace_back(entry.name);
  }
  a.Field({"plant", "", "that is fitted"}, study.plant, Need::kOptional, plants);
  a.Field({"fit", "", "scenarios with a record, whose drives the model is fitted to"}, study.fit,
          Need::kRequired, {});
  a.Field(
      {"held_out", "", "scenarios with a record that are left out of the fit and judged after it"},
      study.held_out, Need::kOptional, {});
  a.Field({"horizon", "s", "the plant restarts at the record after so long"}, study.horizon,
          Need::kOptional, Range{.max = 1e4, .above = 0.0});
  a.Section({"residuals", "", "signals that are fitted; default: yaw_rate with 0.1 rad/s"},
            study.residuals);
  static const EnumNames<RobustLoss> losses{{RobustLoss::kSquared, "squared"},
                                            {RobustLoss::kHuber, "huber"},
                                            {RobustLoss::kSoftL1, "soft_l1"}};
  a.Field({"loss", "", "how large residuals count"}, study.loss, Need::kOptional, losses);
  a.Field({"loss_scale", "", "from how many deviations on they count less"}, study.loss_scale,
          Need::kOptional, kPositive);
  a.List({"parameters", "", "what is estimated"}, study.parameters);
  a.Field({"steering_offset", "",
           "also estimate a constant steering offset, unless it is one of the parameters"},
          study.steering_offset, Need::kOptional);
  a.Section({"bank", "",
             "also estimate the bank of a track or an open road that all records were driven on"},
            study.bank);
  a.Field({"starts", "", "the search begins so often: first at `start`, then at random points"},
          study.starts, Need::kOptional, Range{.min = 1.0, .max = 1000.0});
  a.Field({"evaluations", "", "of the cost, about, from each start: then the search ends"},
          study.evaluations, Need::kOptional, Range{.min = 1.0, .max = 1e6});
  a.Field({"seed", "", "of the random starts"}, study.seed, Need::kOptional);
}

}  // namespace trackbed
