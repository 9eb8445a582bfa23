#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

namespace trackbed {

/// Proposes points (values of the searched keys) in batches; the runs of a batch can be parallel.
/// The proposed points depend only on the search options and on the objective values passed to
/// Tell.
class PointSearch {
 public:
  virtual ~PointSearch() = default;
  /// Returns the next points to run, or an empty list at the end of the search.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Passes to the search the objective values, which the search minimizes, at the points that the
  /// last call of Ask returned. The list `values` contains nullopt for a point whose run has no
  /// objective value.
  virtual void Tell(const std::vector<std::optional<double>>& values) = 0;
};

/// Creates the search that `spec` specifies. The argument `at_nominal` is the objective at the
/// nominal point, if known. The arguments `spec` and `space` must outlive the search.
std::unique_ptr<PointSearch> MakePointSearch(const SearchSpec& spec, const SearchSpace& space,
                                             std::optional<double> at_nominal);

}  // namespace trackbed
