#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/identification.h"

namespace trackbed {

/// Returns whether a parameter of a study is the bank at a knot, and not a number of the car.
bool IsBankParameter(const std::string& name);

/// The bank of a study's track as a function of parameters: the coefficients of a closed spline
/// over the station, one per knot.
class BankModel {
 public:
  /// Makes the track of the study: that of `bank.track`, or the first lap of the first fitted
  /// record, as wide as all records drive. The study must have `bank`. Throws InputError if the
  /// first record does not return to its start, if the track has more knots than the study has room
  /// for, and in the same cases as BankedGround.
  explicit BankModel(const Identification& study);

  /// Returns the parameters, bank[0] at the start line first [rad]. Before the fit, they are
  /// independent with a mean of 0, so the spacing of the knots determines how smooth the bank is.
  [[nodiscard]] std::vector<IdentifiedParameter> Parameters() const;

  /// Returns the track with the bank of the given parameters.
  [[nodiscard]] BankedTrack At(std::span<const double> parameters) const;
  /// Returns the ground with the bank of the given parameters.
  [[nodiscard]] std::shared_ptr<const Terrain> GroundAt(std::span<const double> parameters) const;

 private:
  BankEstimation options_;
  BankedGround ground_;
  ClosedSplineBasis basis_;
};

/// Returns a scenario whose record is driven on the banked track.
Scenario OnGround(Scenario scenario, std::shared_ptr<const BankedTrack> track,
                  std::shared_ptr<const Terrain> terrain);

}  // namespace trackbed
