#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

namespace trackbed {

/// Proposes batches of points that can be run in parallel. Proposals depend only on the search and
/// on the values passed to Tell.
class PointSearch {
 public:
  virtual ~PointSearch() = default;
  /// The next points to run; empty at the end of the search.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// Passes the objective at each point of the last Ask. The objective is to be minimized. The
  /// value of a point is none if the point has no value.
  virtual void Tell(const std::vector<std::optional<double>>& values) = 0;
};

/// `at_nominal` is the objective at the nominal point, if known. `spec` and `space` must outlive
/// the search.
std::unique_ptr<PointSearch> MakePointSearch(const SearchSpec& spec, const SearchSpace& space,
                                             std::optional<double> at_nominal);

}  // namespace trackbed
