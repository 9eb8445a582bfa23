#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "trackbed/recording/banked_track.h"
#include "trackbed/scenario/identification.h"
#include "trackbed/track/closed_spline.h"

namespace trackbed {

/// Returns whether a parameter of a study is the road's bank at a knot, and not a parameter of the
/// car.
bool IsBankParameter(const std::string& name);

/// The bank of a study's track as a function of parameters. The parameters are the coefficients of
/// a spline over the station, one per knot. The spline of a closed track is closed. The spline of
/// an open track is continued as an even function beyond both ends, so its slope is zero at the
/// ends.
class BankModel {
 public:
  /// Makes the track of the study from the key `bank.track`, or from the path of the first fitted
  /// record, with edges that all records stay within. The path of a record is its first lap if the
  /// record returns to its start, else the whole open path. The study must contain the section
  /// `bank`. Throws InputError if a record leaves the path of an open road, or if the track's knots
  /// exceed the maximum number of parameters. The constructor also throws InputError in the same
  /// cases as BankedGround.
  explicit BankModel(const Identification& study);

  /// Returns the parameters, bank[0] at the start line first [rad]. Before the fit, the bank
  /// parameters are independent with a mean of 0, so the spacing of the knots determines how smooth
  /// the bank is.
  [[nodiscard]] std::vector<IdentifiedParameter> Parameters() const;

  /// Returns the track with the bank of the given parameters.
  [[nodiscard]] BankedTrack At(std::span<const double> parameters) const;
  /// Returns the ground with the bank of the given parameters.
  [[nodiscard]] std::shared_ptr<const Terrain> GroundAt(std::span<const double> parameters) const;

 private:
  BankModel(const Identification& study, CenterPoints points);

  BankEstimation options_;
  BankedGround ground_;
  std::size_t knots_;
  ClosedSplineBasis basis_;
};

/// Returns a scenario whose record is driven on the banked track.
Scenario OnGround(Scenario scenario, std::shared_ptr<const BankedTrack> track,
                  std::shared_ptr<const Terrain> terrain);

}  // namespace trackbed
