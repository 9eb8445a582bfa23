#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

namespace trackbed {

/// Proposes points of a study in batches; the scenarios of a batch can be run in parallel. The
/// proposals depend only on the search options and on the values passed to Tell.
class PointSearch {
 public:
  virtual ~PointSearch() = default;
  /// Returns the next points to run; returns no points at the end of the search.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Passes to the search the objective values, which the search minimizes, at the points that the
  /// last call of Ask returned. The list `values` contains none for a point whose run has no
  /// objective.
  virtual void Tell(const std::vector<std::optional<double>>& values) = 0;
};

/// Creates the search that `spec` specifies. The argument `at_nominal` is the objective at the
/// nominal point, if known. The arguments `spec` and `space` must outlive the search.
std::unique_ptr<PointSearch> MakePointSearch(const SearchSpec& spec, const SearchSpace& space,
                                             std::optional<double> at_nominal);

}  // namespace trackbed
