#include "trackbed/report/names.h"

#include <fmt/format.h>

#include <regex>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/path_properties.h"
#include "trackbed/scenario/keys.h"

namespace trackbed {
namespace {

/// Converts a metric's description to the name shown on the page; exponents in units become
/// superscripts, such as m/s² for m/s^2. If no metric is registered under `path`, the shown name is
/// `path` itself.
ShownName Shown(const std::optional<MetricInfo>& info, const std::string& path) {
  if (!info) {
    return {path, ""};
  }
  ShownName name{info->label, info->unit, info->headline, info->limit};
  if (const std::size_t square = name.unit.find("^2"); square != std::string::npos) {
    name.unit = info->unit.substr(0, square) + "²" + info->unit.substr(square + 2);
  }
  return name;
}

/// Removes the part before the first dot from `path` and returns it.
std::string TakeWord(std::string& path) {
  const std::size_t dot = path.find('.');
  std::string word = path.substr(0, dot);
  path.erase(0, dot == std::string::npos ? dot : dot + 1);
  return word;
}

}  // namespace

ShownName NameOfMetric(const std::string& path) {
  return Shown(DescribeMetric(path), path);
}

ShownName NameOfComparison(const std::string& path) {
  return Shown(DescribeComparisonMetric(path), path);
}

ShownName NameOfOutput(const std::string& path) {
  std::string rest = path;
  const std::string kind = TakeWord(rest);
  if (kind == "metrics") {
    const std::string plant = TakeWord(rest);
    ShownName name = NameOfMetric(rest);
    // A label that begins with "…", such as "… at station", continues the label of the row above.
    // Labels that continue the label of the row above are replaced by the metric's path.
    name.label = name.label.starts_with("…") ? rest : name.label;
    name.label += plant == "*" ? "" : fmt::format(" ({})", plant);
    return name;
  }
  if (kind == "between") {
    const std::string first = TakeWord(rest);
    const std::string second = TakeWord(rest);
    ShownName name = NameOfComparison(rest);
    name.label = name.label.starts_with("…") ? rest : name.label;
    name.label += fmt::format(" ({} – {})", first, second);
    return name;
  }
  if (kind == "plan") {
    for (const PathProperty& property : PathProperties()) {
      if (rest == property.name) {
        return Shown(MetricInfo{.label = property.label, .unit = property.unit}, path);
      }
    }
  }
  if (path == "timing.planning_s") {
    return {"Time to plan", "s"};
  }
  return {path, ""};
}

ShownName NameOfKey(const std::string& key) {
  // The table of scenario keys contains N in place of each list index.
  static const std::regex index(R"(\[\d+\])");
  const std::string listed = std::regex_replace(key, index, "[N]");
  for (const KeySection& section : ScenarioKeys()) {
    for (const KeyInfo& info : section.keys) {
      if (listed == (section.key.empty() ? info.name : section.key + "." + info.name)) {
        return {key, info.unit};
      }
    }
  }
  return {key, ""};
}

}  // namespace trackbed
