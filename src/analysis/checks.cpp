#include "trackbed/analysis/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "trackbed/analysis/metric_registry.h"
#include "trackbed/analysis/requirement_metrics.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"

// Checks metrics, requirements and differences between runs for a verdict.
// 1. Each function Check... compares one value with its bound, and returns a Check: the value, the
//    bound, and whether the value meets the bound.
// 2. The check of a metric that the run does not have fails; its message has the reason or the most
//    similar metric name.
// 3. FailureMessage describes a failed Check: plant, value, bound, and the station and time of the
//    value. The failure message shows value and bound with as many digits as are needed to
//    distinguish the two numbers.
namespace trackbed {
namespace {

using nlohmann::ordered_json;

const Metric* Find(const std::vector<Metric>& metrics, const std::string& path) {
  const auto found = std::find_if(metrics.begin(), metrics.end(),
                                  [&](const Metric& metric) { return metric.path == path; });
  return found == metrics.end() ? nullptr : &*found;
}

/// Explains why the run has no value for the metric at `path`.
std::string MissingMetricReason(const std::string& path, const std::vector<Metric>& metrics,
                                const PlantMetrics& plant) {
  if (path.starts_with("turns[")) {
    return fmt::format("{} is not available: the run has {} isolated turn{}", path,
                       plant.turns.size(), plant.turns.size() == 1 ? "" : "s");
  }
  if (path.starts_with("maneuver.") && plant.maneuver && !plant.maneuver->missing.empty()) {
    return fmt::format("{} was not measured: {}", path, plant.maneuver->missing);
  }
  std::vector<std::string> paths;
  for (const Metric& metric : metrics) {
    // In the error message, suggest only the metrics of the first turn, because all turns have the
    // same metrics.
    if (!metric.path.starts_with("turns[") || metric.path.starts_with("turns[0]")) {
      paths.push_back(metric.path);
    }
  }
  return "no metric " + UnknownName(path, paths);
}

std::optional<double> NumberIn(const MetricValue& value) {
  if (const int* number = std::get_if<int>(&value)) {
    return *number;
  }
  const double* number = std::get_if<double>(&value);
  return number != nullptr ? std::optional(*number) : std::nullopt;
}

/// Converts the bound of a check to JSON. A bound whose text is valid JSON, such as "true" or "3",
/// becomes that JSON value; any other text becomes a JSON string.
ordered_json ParsedBound(const MetricValue& bound) {
  const auto* text = std::get_if<std::string>(&bound);
  const ordered_json parsed =
      text == nullptr ? ToJson(bound) : ordered_json::parse(*text, nullptr, false);
  return parsed.is_discarded() ? ordered_json(*text) : parsed;
}

bool IsMet(const MetricValue& value, Relation relation, const MetricValue& bound) {
  if (relation == Relation::kEquals) {
    return std::holds_alternative<std::string>(value) ? value == bound
                                                      : ToJson(value) == ParsedBound(bound);
  }
  const std::optional<double> actual = NumberIn(value);
  const std::optional<double> limit = NumberIn(bound);
  return actual && limit && (relation == Relation::kAtMost ? *actual <= *limit : *actual >= *limit);
}

std::string Where(const MetricPlace& at) {
  switch (at.span) {
    case MetricSpan::kRun:
      return fmt::format(" over the run to s = {:.4g} m, t = {:.4g} s", at.s, at.t);
    case MetricSpan::kEnd:
      return fmt::format(" at the end, s = {:.4g} m, t = {:.4g} s", at.s, at.t);
    case MetricSpan::kMoment:
      return fmt::format(" at s = {:.4g} m, t = {:.4g} s", at.s, at.t);
    case MetricSpan::kSince:
      return fmt::format(" after t = {:.4g} s", at.from_t);
    case MetricSpan::kInterval:
      return fmt::format(" between t = {:.4g} s and {:.4g} s", at.from_t, at.t);
  }
  return "";
}

/// Formats the bound and the measured value, with enough digits that the two formatted numbers
/// differ.
std::pair<std::string, std::string> NumbersApart(const Check& check) {
  return FormatDistinct(NumberIn(check.bound).value_or(0.0), NumberIn(check.value).value_or(0.0));
}

std::string UnequalMessage(const Check& check) {
  const std::string expected = ToText(check.bound);
  if (NumberIn(check.value)) {
    const std::string unit = check.unit.empty() ? "" : " " + check.unit;
    return fmt::format("{} is {}{} instead of {}{}{}", check.name, ToJson(check.value).dump(), unit,
                       expected, unit, Where(check.at));
  }
  return fmt::format("{} is {} instead of {}{}", check.name, ToText(check.value), expected,
                     Where(check.at));
}

std::string ExpectedMessage(const Check& check) {
  if (!check.detail.empty()) {
    return check.detail;
  }
  if (check.relation == Relation::kEquals) {
    return UnequalMessage(check);
  }
  const std::string where = Where(check.at);
  if (std::holds_alternative<std::monostate>(check.value) && check.at.span == MetricSpan::kSince) {
    return fmt::format(
        "{} is not defined: the car did not recover{}; end of the run at s = {:.4g} m, t = {:.4g} "
        "s",
        check.name, where, check.at.s, check.at.t);
  }
  if (!NumberIn(check.value)) {
    return fmt::format("{} is not a number: {}", check.name, ToJson(check.value).dump());
  }
  const auto [bound, value] = NumbersApart(check);
  const std::string unit = check.unit.empty() ? "" : " " + check.unit;
  return fmt::format("{} {}{} {} {}{}{}", check.name, value, unit,
                     check.relation == Relation::kAtMost ? "exceeds" : "is below", bound, unit,
                     where);
}

std::string CorridorMessage(const Check& check) {
  const auto [bound, value] = NumbersApart(check);
  return fmt::format(
      "maximum cross-track error {} m exceeds the car's width of {} m{} (default bound; "
      "expect.max_cross_track overrides it)",
      value, bound, Where(check.at));
}

std::string OverspeedMessage(const Check& check) {
  const auto [bound, value] = NumbersApart(check);
  return fmt::format(
      "the car is {} m/s faster than planned, more than the {} m/s that the speed control can "
      "correct{} (default bound; an expectation on overspeed_max overrides it)",
      value, bound, Where(check.at));
}

std::string OscillationMessage(const Check& check) {
  return fmt::format(
      "the steering command oscillates by {:.3g} rad to each side at {} Hz without decaying{} "
      "(default check; an expectation on oscillation.amplitude replaces it)",
      NumberIn(check.value).value_or(0.0), check.detail, Where(check.at));
}

std::string RequirementMessage(const Check& check) {
  if (!check.detail.empty()) {
    return fmt::format("requirement '{}': {}", check.name, check.detail);
  }
  const double robustness = NumberIn(check.value).value_or(0.0);
  return fmt::format("requirement '{}': robustness {:.4g}{}{}", check.name, robustness,
                     robustness == 0.0 ? ", which its strict comparison excludes," : "",
                     Where(check.at));
}

std::string CollisionMessage(const Check& check) {
  return check.value == MetricValue(true)
             ? "unexpected collision" + Where(check.at)
             : fmt::format("expected a collision; minimum clearance {} m{}", check.detail,
                           Where(check.at));
}

}  // namespace

const char* ToString(Relation relation) {
  switch (relation) {
    case Relation::kAtMost:
      return "at_most";
    case Relation::kAtLeast:
      return "at_least";
    case Relation::kEquals:
      return "equals";
  }
  return "";
}

Check CheckMetric(const PlantMetrics& plant, const std::string& path, Relation relation,
                  const MetricValue& bound) {
  const std::vector<Metric> metrics = ListMetrics(plant);
  const std::optional<MetricInfo> info = DescribeMetric(path);
  Check check{.plant = plant.plant,
              .metric = path,
              .relation = relation,
              .bound = bound,
              .name = path,
              .unit = info ? info->unit : ""};
  if (const Metric* found = Find(metrics, path)) {
    check.value = found->value;
    check.at = found->at;
    check.met = IsMet(found->value, relation, bound);
  } else {
    check.detail = MissingMetricReason(path, metrics, plant);
  }
  return check;
}

Check CheckRequirement(const std::string& plant, const RequirementMetrics& requirement) {
  Check check{.plant = plant,
              .metric = RequirementPath(requirement.name),
              .relation = Relation::kAtLeast,
              .bound = 0.0,
              .met = requirement.satisfied,
              .reason = CheckReason::kRequirement,
              .name = requirement.name,
              .detail = requirement.problem,
              .formula = requirement.formula};
  if (requirement.robustness) {
    check.value = *requirement.robustness;
    check.at = {.span = MetricSpan::kMoment, .s = requirement.s, .t = requirement.t};
  }
  return check;
}

std::string PlantsOf(const Check& check) {
  return check.other.empty() ? check.plant : fmt::format("{} – {}", check.plant, check.other);
}

std::vector<Check> CheckBounds(const DifferenceBounds& bounds, const PlantComparison& comparison) {
  if (!comparison.comparable()) {
    return {{.plant = comparison.first,
             .other = comparison.second,
             .metric = "compared",
             .relation = Relation::kEquals,
             .bound = "true",
             .value = false,
             .reason = CheckReason::kComparable,
             .detail = "their station ranges do not overlap"}};
  }
  std::vector<Check> checks;
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    if (const std::optional<double>& bound = bounds.*quantity.bound) {
      const Difference& difference = comparison.*quantity.difference;
      checks.push_back(
          {.plant = comparison.first,
           .other = comparison.second,
           .metric = std::string(quantity.key) + ".max",
           .relation = Relation::kAtMost,
           .bound = *bound,
           .value = difference.max,
           .at = {.span = MetricSpan::kMoment, .s = difference.max_s, .t = difference.max_t},
           .met = IsMet(difference.max, Relation::kAtMost, *bound),
           .name = std::string(quantity.name) + " difference",
           .unit = quantity.unit});
    }
  }
  return checks;
}

std::string FailureMessage(const Check& check) {
  const auto message = [&]() -> std::string {
    switch (check.reason) {
      case CheckReason::kExpected:
        return ExpectedMessage(check);
      case CheckReason::kArrival:
        return fmt::format("did not {}: {} at s = {:.4g} m, t = {:.4g} s{}", check.name,
                           ToText(check.value), check.at.s, check.at.t, check.detail);
      case CheckReason::kNoContact:
        // No message for this check, because the check kArrival already reports the contact with
        // the obstacle.
        return "";
      case CheckReason::kCorridor:
        return CorridorMessage(check);
      case CheckReason::kOverspeed:
        return OverspeedMessage(check);
      case CheckReason::kOscillation:
        return OscillationMessage(check);
      case CheckReason::kSteeringRate:
        return fmt::format(
            "steering rate {:.4g} rad/s exceeds the actuator limit of {} rad/s{}; drive.timestep "
            "is too long for this car",
            NumberIn(check.value).value_or(0.0), check.detail, Where(check.at));
      case CheckReason::kCollision:
        return CollisionMessage(check);
      case CheckReason::kComparable:
        return "cannot be compared: " + check.detail;
      case CheckReason::kSameEnd:
        return fmt::format("end status differs: {} {}, {} {}", check.plant, ToText(check.bound),
                           check.other, ToText(check.value));
      case CheckReason::kRequirement:
        return RequirementMessage(check);
    }
    return "";
  }();
  if (message.empty() || check.reason == CheckReason::kSameEnd) {
    return message;
  }
  return fmt::format("{}{}: {}", check.plant, check.other.empty() ? "" : " and " + check.other,
                     message);
}

std::vector<std::string> Exceeded(const DifferenceBounds& bounds,
                                  const PlantComparison& comparison) {
  std::vector<std::string> messages;
  for (const Check& check : CheckBounds(bounds, comparison)) {
    if (!check.met) {
      messages.push_back(FailureMessage(check));
    }
  }
  return messages;
}

ordered_json ToJson(const Check& check) {
  const bool placed = check.at.span == MetricSpan::kMoment || check.at.span == MetricSpan::kEnd;
  ordered_json json{{"plant", PlantsOf(check)},
                    {"metric", check.metric},
                    {"relation", ToString(check.relation)},
                    {"bound", ParsedBound(check.bound)},
                    {"value", ToJson(check.value)},
                    {"station", placed ? ordered_json(check.at.s) : ordered_json(nullptr)},
                    {"time", placed ? ordered_json(check.at.t) : ordered_json(nullptr)},
                    {"met", check.met}};
  if (!check.formula.empty()) {
    json["formula"] = check.formula;
  }
  return json;
}

}  // namespace trackbed
