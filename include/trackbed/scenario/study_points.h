#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/scenario/study.h"

/// Computes the points of a study: the settings and the scenario of each run.
namespace trackbed {

/// A point of a study: the settings of one run, and the scenario with these settings.
struct StudyPoint {
  std::vector<Setting> settings;  ///< Settings at this point, from `vary`, `list` and `derive`.
  /// Scenario with the settings of this point; a bisected key has its lowest value `from`.
  Scenario scenario;
  /// Reason why the scenario at this point is invalid; empty if the scenario is valid.
  std::string refused{};
};

/// Reads the scenario at a point of a study, with the bisected key set to `bisected`. Throws
/// InputError in the same cases as ReadScenario. For a problem in a setting of the study, the
/// InputError states the position in the study's file.
Scenario ReadPoint(const Study& study, const std::vector<Setting>& settings,
                   std::optional<double> bisected = {});

/// Makes the point of the study with the given settings, and computes the derived keys. If the
/// scenario is invalid, StudyPoint::refused is the first problem.
StudyPoint PointWith(const Study& study, std::vector<Setting> settings);

/// Returns the numeric value of a key in the scenario, including default values; nullopt if there
/// is no such key.
std::optional<double> NumberAt(const Scenario& scenario, const std::string& key);

/// The points of a study, which are computed on demand and not stored. The points of a study are
/// ordered as in nested loops. The keys of `vary` are the outer loops in the order of the file,
/// `list` is the next inner loop, and the sample is the innermost loop.
///
/// Guarantees: the same study always has the same points. Several threads may read points at the
/// same time, because StudyPoints cannot be changed after construction. If points of the grid
/// differ only in a key whose condition does not hold, only one of these points is kept.
class StudyPoints {
 public:
  /// Throws InputError if keys have distributions but the study has no section `sample`.
  explicit StudyPoints(Study study);

  [[nodiscard]] const Study& study() const { return study_; }
  [[nodiscard]] std::size_t size() const { return combinations_ * samples(); }
  /// Returns the settings of the point with index `i`. Throws InputError if a formula cannot be
  /// evaluated at this point.
  [[nodiscard]] std::vector<Setting> Settings(std::size_t i) const;
  /// Returns the point with index `i`. If the scenario is invalid, StudyPoint::refused is the first
  /// problem.
  [[nodiscard]] StudyPoint Read(std::size_t i) const;

 private:
  [[nodiscard]] std::size_t samples() const;
  [[nodiscard]] std::vector<Setting> OfGrid(std::size_t combination) const;
  void KeepDistinctPoints();

  Study study_;
  std::size_t combinations_ = 1;  // Number of points in the grid.
  // Indices of the distinct points of the grid; empty if all points are distinct.
  std::vector<std::size_t> distinct_{};
  // Sample with one row per point and one column per sampled key.
  Eigen::MatrixXd unit_sample_;
  // Column in `unit_sample_` of each key of `vary`; -1 if the key is not sampled.
  std::vector<int> dimensions_;
};

}  // namespace trackbed
