#include "src/scenario/check_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "src/scenario/visit.h"
#include "src/scenario/yaml_value.h"
#include "trackbed/core/spelling.h"
#include "trackbed/options/number_visitor.h"
#include "trackbed/scenario/cameras.h"

namespace trackbed {
namespace {

/// Checks the values of scenario keys against the declared ranges and names.
class ValueChecker final : public NumberVisitor {
 public:
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> TakeFound() {
    return std::move(found_);
  }

  using NumberVisitor::Field;
  void Field(const Key& key, double& value, Need, Range range) override {
    Check(Dotted(key), value, WithinReason(key, range));
  }
  void Field(const Key& key, std::optional<double>& value, Range range) override {
    if (value) {
      Check(Dotted(key), *value, WithinReason(key, range));
    }
  }
  void Field(const Key& key, std::vector<double>& value, Need, Range range) override {
    for (std::size_t i = 0; i < value.size(); ++i) {
      Check(Element(key, i), value[i], WithinReason(key, range));
    }
  }
  // The visitor gets an empty text for an enumerator that has no name.
  void Field(const Key& key, std::string& value, Need need, const Names& allowed) override {
    if (!value.empty()) {
      CheckName(Dotted(key), value, allowed);
    } else if (!allowed.empty()) {
      found_.emplace_back(Dotted(key),
                          fmt::format("unknown value; allowed: {}", fmt::join(allowed, ", ")));
    } else if (need == Need::kRequired) {
      found_.emplace_back(Dotted(key), "missing");
    }
  }
  void Field(const Key& key, std::optional<std::string>& value) override {
    if (value && value->empty()) {
      found_.emplace_back(Dotted(key), "expected a name, found an empty text");
    }
  }
  void Field(const Key& key, std::vector<std::string>& value, Need, const Names& allowed) override {
    for (auto name = value.begin(); name != value.end(); ++name) {
      const std::string dotted = Element(key, static_cast<std::size_t>(name - value.begin()));
      CheckName(dotted, *name, allowed);
      if (std::find(value.begin(), name, *name) != name) {
        found_.emplace_back(dotted, fmt::format("'{}' is listed twice", *name));
      }
    }
  }
  void Identifier(const Key& key, std::string& value) override {
    const std::string problem = value.empty() ? "missing" : FolderNameProblem(value);
    if (!problem.empty()) {
      found_.emplace_back(Dotted(key), problem);
    }
  }

 protected:
  void Number(const Key& key, double& value, const Range& range) override {
    Check(Dotted(key), value, range);
  }
  void Pairs(const Key& key, std::vector<Vec2>& pairs, const PairShape& shape) override {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      Check(Element(key, i) + "[0]", pairs[i].x(), shape.first);
      Check(Element(key, i) + "[1]", pairs[i].y(), shape.second);
    }
  }

 private:
  [[nodiscard]] std::string Dotted(const Key& key) const {
    return place().empty() ? key.name : fmt::format("{}.{}", place(), key.name);
  }
  [[nodiscard]] std::string Element(const Key& key, std::size_t i) const {
    return fmt::format("{}[{}]", Dotted(key), i);
  }

  void Check(const std::string& dotted, double value, const Range& range) {
    if (const std::string problem = NumberProblem(value, range); !problem.empty()) {
      found_.emplace_back(dotted, problem);
    }
  }
  void CheckName(const std::string& dotted, const std::string& name, const Names& allowed) {
    if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), name) == allowed.end()) {
      found_.emplace_back(dotted, "unknown " + UnknownName(name, allowed));
    }
  }

  std::vector<std::pair<std::string, std::string>> found_;
};

using Found = std::vector<std::pair<std::string, std::string>>;

/// Checks that the content of a file that the scenario names was read. A program may set the
/// content of an input file in memory, without a file name. For content without a file name,
/// CheckContent sets `file` to a placeholder, because the key of the file is required.
void CheckContent(const std::string& key, bool is_read, std::string& file, Found& found) {
  if (is_read && file.empty()) {
    file = "content set by the program";
  } else if (!is_read && !file.empty()) {
    found.emplace_back(
        key, fmt::format("{} has not been read; ReadScenario and ParseScenario read it", file));
  }
}

/// Checks that the content of each input file was read, and sets a placeholder name for contents
/// without a file name.
Found CheckContents(Scenario& scenario) {
  Found found;
  if (auto& record = scenario.record) {
    CheckContent("record.file", record->data != nullptr, record->file, found);
    if (record->ground) {
      CheckContent("record.ground", record->ground_data != nullptr, *record->ground, found);
    }
  }
  if (auto& track = scenario.mission.track) {
    CheckContent("mission.track.file", track->data != nullptr, track->file, found);
  }
  if (auto& map = scenario.world.map) {
    CheckContent("world.map.file", map->data != nullptr, map->file, found);
  }
  if (auto& roads = scenario.world.road_network) {
    CheckContent("world.road_network", roads->data != nullptr, roads->file, found);
  }
  return found;
}

/// Checks that the lists of a scenario name each plant once.
void CheckPlantsOfExpectations(const Scenario& scenario, Found& found) {
  const auto& plants = scenario.expect.plants;
  for (auto own = plants.begin(); own != plants.end(); ++own) {
    if (std::any_of(plants.begin(), own,
                    [&](const auto& other) { return other.first == own->first; })) {
      found.emplace_back("expect." + own->first, fmt::format("'{}' is listed twice", own->first));
    }
  }
}

}  // namespace

std::string OriginProblem(const std::vector<double>& origin) {
  const bool is_whole = origin.size() == 2 &&
                        std::all_of(origin.begin(), origin.end(),
                                    [](double number) { return std::fmod(number, 1.0) == 0.0; });
  return is_whole ? "" : "must be two whole numbers [x, y], such as [500000, 5200000]";
}

std::string CameraProblem(const std::string& camera) {
  std::vector<std::string> names;
  for (const CameraName& each : CameraNames()) {
    names.push_back(each.name);
  }
  return std::find(names.begin(), names.end(), camera) == names.end()
             ? "unknown " + UnknownName(camera, names)
             : "";
}

std::vector<std::pair<std::string, std::string>> ValueProblems(const Scenario& scenario) {
  Scenario visited = scenario;
  const Found contents = CheckContents(visited);
  ValueChecker checker;
  Visit(checker, visited);
  Found found = checker.TakeFound();
  found.insert(found.end(), contents.begin(), contents.end());
  CheckPlantsOfExpectations(scenario, found);
  if (scenario.origin && scenario.origin->allFinite()) {
    const std::string problem = OriginProblem({scenario.origin->x(), scenario.origin->y()});
    if (!problem.empty()) {
      found.emplace_back("origin", problem);
    }
  }
  if (const std::string problem = CameraProblem(scenario.render.camera); !problem.empty()) {
    found.emplace_back("render.camera", problem);
  }
  return found;
}

}  // namespace trackbed
