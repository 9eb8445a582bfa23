#include "src/report/expectations.h"

#include <fmt/format.h>

#include <algorithm>

#include "src/report/names.h"
#include "src/report/paths.h"
#include "trackbed/core/text_table.h"
#include "trackbed/drive/run_log.h"

namespace trackbed {
namespace {

using nlohmann::ordered_json;

/// Gathers the rows about one plant, or one pair of plants.
class Rows {
 public:
  Rows(std::string of, const ordered_json& found, ordered_json& rows)
      : of_(std::move(of)), values_(LeafValues(found)), rows_(rows) {}

  void AtMost(const ShownName& name, const std::string& path, const std::optional<double>& bound) {
    if (bound) {
      const ordered_json* value = Find(path);
      Add(name, "≤ " + ShortestText(*bound), value,
          value != nullptr && value->is_number() && value->get<double>() <= *bound);
    }
  }

  void AtLeast(const ShownName& name, const std::string& path, const std::optional<double>& bound) {
    if (bound) {
      const ordered_json* value = Find(path);
      Add(name, "≥ " + ShortestText(*bound), value,
          value != nullptr && value->is_number() && value->get<double>() >= *bound);
    }
  }

  void Equal(const ShownName& name, const std::string& path,
             const std::optional<std::string>& wanted) {
    if (wanted) {
      const ordered_json* value = Find(path);
      const ordered_json parsed = ordered_json::parse(*wanted, nullptr, false);
      Add(name, fmt::format("= {}", *wanted), value,
          value != nullptr && (value->is_string() ? value->get<std::string>() == *wanted
                                                  : !parsed.is_discarded() && *value == parsed));
    }
  }

  [[nodiscard]] bool Has(const std::string& path) const { return Find(path) != nullptr; }

 private:
  [[nodiscard]] const ordered_json* Find(const std::string& path) const {
    const auto found = std::find_if(values_.begin(), values_.end(),
                                    [&](const auto& leaf) { return leaf.first == path; });
    return found == values_.end() ? nullptr : &found->second;
  }

  void Add(const ShownName& name, const std::string& asked, const ordered_json* found, bool met) {
    rows_.push_back({{"of", of_},
                     {"what", name.label},
                     {"unit", name.unit},
                     {"asked", asked},
                     {"found", found == nullptr ? ordered_json(nullptr) : RoundedLeaf(*found)},
                     {"met", met}});
  }

  std::string of_;
  std::vector<std::pair<std::string, ordered_json>> values_;
  ordered_json& rows_;
};

void AddPlant(const PlantExpectation& expect, const std::string& plant, const ordered_json& found,
              ordered_json& all) {
  Rows rows(plant, found, all);
  // Without a path, or without obstacles, nothing is asked of how they were kept.
  if (rows.Has("goal_distance")) {
    rows.AtMost(NameOfMetric("goal_distance"), "goal_distance", expect.reach_goal);
    rows.AtMost(NameOfMetric("cross_track.max"), "cross_track.max", expect.max_cross_track);
    rows.AtMost(NameOfMetric("cross_track.rms"), "cross_track.rms", expect.rms_cross_track);
    rows.AtMost(NameOfMetric("heading_error.max"), "heading_error.max", expect.max_heading_error);
  }
  if (rows.Has("clearance_min")) {
    rows.AtLeast(NameOfMetric("clearance_min"), "clearance_min", expect.min_clearance);
    rows.Equal(
        NameOfMetric("collision"), "collision",
        expect.collision ? std::optional(*expect.collision ? "true" : "false") : std::nullopt);
  }
  for (const MetricExpectation& metric : expect.metrics) {
    const ShownName name = NameOfMetric(metric.metric);
    rows.AtLeast(name, metric.metric, metric.min);
    rows.AtMost(name, metric.metric, metric.max);
    rows.Equal(name, metric.metric, metric.equals);
  }
}

bool ExpectsCollision(const Expectations& expect, const std::string& plant) {
  bool expected = expect.all.collision.value_or(false);
  for (const auto& [name, own] : expect.plants) {
    expected = name == plant ? own.collision.value_or(expected) : expected;
  }
  return expected;
}

/// Whether the scenario itself says how the drive is to end.
bool AsksForStatus(const Expectations& expect, const std::string& plant) {
  const auto asks = [](const PlantExpectation& own) {
    return std::any_of(own.metrics.begin(), own.metrics.end(),
                       [](const MetricExpectation& metric) { return metric.metric == "status"; });
  };
  return asks(expect.all) ||
         std::any_of(expect.plants.begin(), expect.plants.end(),
                     [&](const auto& own) { return own.first == plant && asks(own.second); });
}

}  // namespace

ordered_json ExpectationRows(const Expectations& expect, const ordered_json& metrics) {
  ordered_json all = ordered_json::array();
  for (const auto& [plant, found] : metrics.at("plants").items()) {
    // Asked of every drive; one that is to collide may end so.
    const bool collides =
        ExpectsCollision(expect, plant) && found.at("status") == ToString(DriveStatus::kCollided);
    if (!AsksForStatus(expect, plant)) {
      Rows(plant, found, all)
          .Equal(NameOfMetric("status"), "status",
                 ToString(collides ? DriveStatus::kCollided : DriveStatus::kArrived));
    }
    AddPlant(expect.all, plant, found, all);
    for (const auto& [name, own] : expect.plants) {
      if (name == plant) {
        AddPlant(own, plant, found, all);
      }
    }
  }
  for (const BetweenExpectation& between : expect.between) {
    for (const ordered_json& found : metrics.at("between")) {
      const auto plants = found.at("plants").get<std::vector<std::string>>();
      if (!std::is_permutation(plants.begin(), plants.end(), between.plants.begin(),
                               between.plants.end())) {
        continue;
      }
      Rows rows(fmt::format("{} – {}", plants[0], plants[1]), found, all);
      rows.AtMost(NameOfComparison("position.max"), "position.max", between.bounds.position_max);
      rows.AtMost(NameOfComparison("heading.max"), "heading.max", between.bounds.heading_max);
      rows.AtMost(NameOfComparison("yaw_rate.max"), "yaw_rate.max", between.bounds.yaw_rate_max);
      rows.AtMost(NameOfComparison("steering.max"), "steering.max", between.bounds.steering_max);
    }
  }
  return all;
}

}  // namespace trackbed
