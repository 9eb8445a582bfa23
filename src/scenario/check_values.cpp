#include "src/scenario/check_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>

#include "src/scenario/visit.h"
#include "src/scenario/yaml_value.h"
#include "trackbed/core/spelling.h"
#include "trackbed/options/number_visitor.h"
#include "trackbed/scenario/cameras.h"

namespace trackbed {
namespace {

/// Checks the values of keys against the declarations of the keys.
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
  void Field(const Key& key, std::string& value, Need, const Names& allowed) override {
    if (!value.empty()) {
      CheckName(Dotted(key), value, allowed);
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
    const std::string problem = value.empty() ? "" : FolderNameProblem(value);
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

}  // namespace

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
  ValueChecker checker;
  Visit(checker, visited);
  std::vector<std::pair<std::string, std::string>> found = checker.TakeFound();
  if (const std::string problem = CameraProblem(scenario.render.camera); !problem.empty()) {
    found.emplace_back("render.camera", problem);
  }
  return found;
}

}  // namespace trackbed
