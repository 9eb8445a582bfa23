#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "trackbed/falsify/search_space.h"

namespace trackbed {

/// Proposes points to run, some at a time, which may be run in parallel. What it proposes depends
/// on the search and on what it was told, and on nothing else.
class PointSearch {
 public:
  virtual ~PointSearch() = default;
  /// None at its end.
  virtual std::vector<UnitPoint> Ask() = 0;
  /// What is to be minimized, one for each point of Ask; none: the point has no value.
  virtual void Tell(const std::vector<std::optional<double>>& values) = 0;
};

/// `at_nominal` is what is known of the nominal point. Both must live as long as the search.
std::unique_ptr<PointSearch> MakePointSearch(const SearchSpec& spec, const SearchSpace& space,
                                             std::optional<double> at_nominal);

}  // namespace trackbed
