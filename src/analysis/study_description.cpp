#include "src/analysis/study_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "trackbed/core/hash.h"
#include "trackbed/core/text_table.h"

namespace trackbed {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

std::vector<std::string> ParameterKeys(const Study& study) {
  std::vector<std::string> keys;
  for (const Variation& variation : study.vary) {
    keys.push_back(variation.key);
  }
  for (const auto& point : study.list) {
    for (const Setting& setting : point) {
      if (std::find(keys.begin(), keys.end(), setting.key) == keys.end()) {
        keys.push_back(setting.key);
      }
    }
  }
  for (const DerivedKey& derived : study.derive) {
    keys.push_back(derived.key);
  }
  return keys;
}

std::vector<std::string> TableColumns(const Study& study) {
  std::vector<std::string> columns = ParameterKeys(study);
  if (study.bisect) {
    columns.push_back(study.bisect->key);
  }
  if (study.repeat > 1) {
    columns.emplace_back("seed");
  }
  columns.emplace_back("status");
  if (study.bisect) {
    columns.emplace_back("runs");
  }
  for (const OutputSpec& output : study.outputs) {
    columns.push_back(output.path);
  }
  columns.emplace_back("reason");
  return columns;
}

ordered_json SettingsJson(const std::string& value) {
  ordered_json json = ordered_json::parse(CellText(value), nullptr, false);
  return json.is_discarded() ? ordered_json(value) : json;
}

ordered_json SettingsJson(const std::vector<Setting>& settings) {
  ordered_json json = ordered_json::object();
  for (const Setting& setting : settings) {
    json[setting.key] = SettingsJson(setting.value);
  }
  return json;
}

namespace {

ordered_json DistributionJson(const Variation& variation) {
  const Distribution& distribution = *variation.distribution;
  ordered_json json{{"distribution", ToString(distribution.kind)}};
  switch (distribution.kind) {
    case DistributionKind::kUniform:
    case DistributionKind::kLogUniform:
    case DistributionKind::kInteger:
      json["from"] = distribution.from;
      json["to"] = distribution.to;
      break;
    case DistributionKind::kNormal:
      json["mean"] = distribution.mean;
      json["deviation"] = distribution.deviation;
      if (std::isfinite(distribution.min)) {
        json["min"] = distribution.min;
      }
      if (std::isfinite(distribution.max)) {
        json["max"] = distribution.max;
      }
      break;
    case DistributionKind::kChoice:
      if (variation.rows_of.empty()) {
        for (const std::string& value : distribution.values) {
          json["values"].push_back(SettingsJson(value));
        }
      } else {
        json["file"] = variation.rows_of;
        json["sha256"] = Sha256(fmt::format("{}", fmt::join(distribution.values, "\n")));
      }
      if (!distribution.weights.empty()) {
        json["weights"] = distribution.weights;
      }
      break;
  }
  return json;
}

/// Converts the variation of a key to a JSON list of its values, or to a JSON object if the
/// variation has further parameters.
ordered_json VariationJson(const Variation& variation) {
  ordered_json json = ordered_json::array();
  if (variation.distribution) {
    json = DistributionJson(variation);
  } else {
    for (const Setting& setting : variation.alternatives) {
      json.push_back(SettingsJson(setting.value));
    }
  }
  if (!variation.when.empty()) {
    if (json.is_array()) {
      json = {{"values", json}};
    }
    for (const Condition& condition : variation.when) {
      for (const std::string& value : condition.values) {
        json["when"][condition.key].push_back(SettingsJson(value));
      }
    }
  }
  return json;
}

}  // namespace

ordered_json DescribeStudy(const Study& study) {
  // Write the scenario's absolute path without links, so that the description depends neither on
  // the current folder nor on how the path is spelled.
  const fs::path scenario = fs::weakly_canonical(fs::absolute(study.scenario));
  ordered_json json{{"study", study.name}, {"scenario", scenario.string()}};
  json["set"] = SettingsJson(study.set);
  json["overrides"] = study.overrides;
  json["vary"] = ordered_json::object();
  for (const Variation& variation : study.vary) {
    json["vary"][variation.key] = VariationJson(variation);
  }
  if (study.sample) {
    json["sample"] = {{"count", study.sample->count},
                      {"method", ToString(study.sample->method)},
                      {"seed", study.sample->seed}};
  }
  for (const DerivedKey& derived : study.derive) {
    json["derive"][derived.key] = derived.formula;
  }
  json["list"] = ordered_json::array();
  for (const auto& point : study.list) {
    json["list"].push_back(SettingsJson(point));
  }
  json["repeat"] = study.repeat;
  if (study.bisect) {
    json["bisect"] = {{"key", study.bisect->key},
                      {"from", study.bisect->from},
                      {"to", study.bisect->to},
                      {"tolerance", study.bisect->tolerance}};
  }
  json["outputs"] = ordered_json::array();
  for (const OutputSpec& output : study.outputs) {
    json["outputs"].push_back(output.path);
  }
  if (study.keep.rows == KeepSpec::Rows::kHighest || study.keep.rows == KeepSpec::Rows::kLowest) {
    json["keep"] = {{"count", study.keep.count},
                    {"by", study.keep.by},
                    {"highest", study.keep.rows == KeepSpec::Rows::kHighest}};
  } else if (study.keep.rows != KeepSpec::Rows::kNone) {
    json["keep"] = ToString(study.keep);
  }
  return json;
}

}  // namespace trackbed
