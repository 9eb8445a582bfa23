#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/scenario/map_range.h"
#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// The axis along which a number is a coordinate.
enum class MapAxis { kX, kY };

/// Calls a function for each coordinate of a place that the keys of a struct contain
/// (IsCoordinate). The function may change the coordinate.
class PlaceVisitor final : public KeyVisitor {
 public:
  /// The argument `place` is the dotted key of the place, such as "world.obstacles[0].box" or
  /// "mission.waypoints[2]"; both coordinates of a place have the same.
  using Take = std::function<void(const std::string& place, MapAxis axis, double& value)>;

  explicit PlaceVisitor(Take take) : take_(std::move(take)) {}

  [[nodiscard]] Mode mode() const override { return Mode::kWrite; }

  using KeyVisitor::Field;
  void Field(const Key& key, double& value, Need, Range range) override {
    Visited(value, range, AxisOf(key));
  }
  void Field(const Key& key, std::optional<double>& value, Range range) override {
    if (value) {
      Visited(*value, range, AxisOf(key));
    }
  }
  void Field(const Key&, std::optional<bool>&) override {}
  void Field(const Key&, bool&, Need) override {}
  void Field(const Key&, int&, Need, Range) override {}
  void Field(const Key&, std::uint64_t&, Need) override {}
  void Field(const Key&, std::string&, Need, const Names&) override {}
  void Field(const Key&, std::optional<std::string>&) override {}
  void Field(const Key&, std::vector<std::string>&, Need, const Names&) override {}
  void Field(const Key& key, std::vector<Vec2>& value, Need, const PairShape& shape) override {
    for (std::size_t i = 0; i < value.size(); ++i) {
      Within(fmt::format("{}[{}]", key.name, i), [&](KeyVisitor&) {
        Visited(value[i].x(), shape.first, MapAxis::kX);
        Visited(value[i].y(), shape.second, MapAxis::kY);
      });
    }
  }
  void Field(const Key&, std::vector<double>&, Need, Range) override {}
  void Identifier(const Key&, std::string&) override {}
  void Pair(const Key&, int&, int&, Range) override {}

 protected:
  bool VisitSection(const Key& key, Need, bool present, const Inside& inside) override {
    if (present) {
      Within(key.name, inside);
    }
    return present;
  }
  void VisitList(const Key& key, std::size_t size, const std::function<void(std::size_t)>&,
                 const std::function<void(KeyVisitor&, std::size_t)>& visit) override {
    for (std::size_t i = 0; i < size; ++i) {
      Within(fmt::format("{}[{}]", key.name, i), [&](KeyVisitor& keys) { visit(keys, i); });
    }
  }
  void VisitMethod(const Key& key, Need, const Methods& methods) override {
    if (methods.selected) {
      Within(key.name, methods.visit_selected);
      Within(key.name, methods.rest);
    }
  }

 private:
  void Within(const std::string& key, const Inside& inside) {
    const std::string outside = place_;
    place_ += (place_.empty() ? "" : ".") + key;
    inside(*this);
    place_ = outside;
  }

  static MapAxis AxisOf(const Key& key) {
    return std::string_view(key.name) == "x" ? MapAxis::kX : MapAxis::kY;
  }

  void Visited(double& value, const Range& range, MapAxis axis) {
    if (IsCoordinate(range)) {
      take_(place_, axis, value);
    }
  }

  Take take_;
  std::string place_;
};

}  // namespace trackbed
