#pragma once

#include <fmt/format.h>

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/scenario/map_range.h"
#include "trackbed/options/number_visitor.h"

namespace trackbed {

/// Map axis (x or y) along which a number is a coordinate.
enum class MapAxis { kX, kY };

/// Calls a function for each coordinate of a place that the keys of a struct contain
/// (IsCoordinate). The function that PlaceVisitor calls may change the coordinate.
class PlaceVisitor final : public NumberVisitor {
 public:
  /// The argument `place` is the dotted key of the place, such as "world.obstacles[0].box" or
  /// "mission.waypoints[2]"; both coordinates of a place have the same key `place`.
  using Take = std::function<void(const std::string& place, MapAxis axis, double& value)>;

  explicit PlaceVisitor(Take take) : take_(std::move(take)) {}

 protected:
  void Number(const Key& key, double& value, const Range& range) override {
    const bool is_x = std::string_view(key.name) == "x";
    Visited(value, range, is_x ? MapAxis::kX : MapAxis::kY);
  }
  void Pairs(const Key& key, std::vector<Vec2>& pairs, const PairShape& shape) override {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Within(fmt::format("{}[{}]", key.name, i), [&](KeyVisitor&) {
        Visited(pairs[i].x(), shape.first, MapAxis::kX);
        Visited(pairs[i].y(), shape.second, MapAxis::kY);
      });
    }
  }

 private:
  void Visited(double& value, const Range& range, MapAxis axis) {
    if (IsCoordinate(range)) {
      take_(place(), axis, value);
    }
  }

  Take take_;
};

}  // namespace trackbed
