#include "src/report/study_statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "src/report/numbers.h"
#include "trackbed/analysis/statistics.h"

// Computes the statistics of a study for its page (statistics.h): the pass rate, and statistics of
// each output. The statistics of an output are its quantiles, its distribution function, and its
// first-order sensitivity to each varied parameter. The statistics of an output also include its
// mean in each class of a parameter, and its rank correlations with other outputs. The statistics
// use only rows with a result, and omit outputs with fewer than 20 values. For large studies,
// StudyRowsToShow selects evenly spaced rows, plus the rows with the ten lowest and ten highest
// values of each output.
namespace trackbed {
namespace {

using nlohmann::ordered_json;

constexpr double kConfidence = 0.95;
constexpr std::size_t kMinRows = 20;
// Maximum number of classes of a parameter in a chart of effects.
constexpr std::size_t kMaxEffectClasses = 12;
// Maximum number of outputs whose correlations are computed.
constexpr std::size_t kMaxCorrelatedOutputs = 24;
// Maximum number of points of a drawn distribution function.
constexpr std::size_t kMaxStaircasePoints = 200;

ordered_json IntervalJson(const Interval& interval) {
  return {Rounded(interval.low), Rounded(interval.high)};
}

/// Indices of the columns of a study's table, grouped by kind.
struct StudyColumns {
  explicit StudyColumns(const TextTable& table) {
    const std::vector<std::string>& names = table.columns();
    status =
        static_cast<std::size_t>(std::find(names.begin(), names.end(), "status") - names.begin());
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i < status && names[i] != "seed") {
        parameters.push_back(i);
      } else if (i > status && names[i] != "runs" && names[i] != "reason" && IsNumeric(table, i)) {
        outputs.push_back(i);
      }
    }
  }

  /// Whether the column has at least one non-empty cell, and all non-empty cells are numbers.
  static bool IsNumeric(const TextTable& table, std::size_t column) {
    bool any = false;
    for (const std::vector<std::string>& row : table.rows()) {
      const bool is_number = CellNumber(row[column]).has_value();
      if (!is_number && !row[column].empty()) {
        return false;
      }
      any = any || is_number;
    }
    return any;
  }

  std::size_t status = 0;
  std::vector<std::size_t> parameters;
  std::vector<std::size_t> outputs;
};

/// Values of an output, and the numbers of the rows that contain these values.
struct Sample {
  std::vector<std::size_t> rows;
  std::vector<double> values;
};

/// Returns the number of classes into which a numeric parameter is divided, so that each class has
/// about thirty rows.
std::size_t ClassesFor(std::size_t rows) {
  return std::clamp<std::size_t>(rows / 30, 2, 64);
}

class StudyAnalysis {
 public:
  explicit StudyAnalysis(const TextTable& table) : table_(table), columns_(table) {
    for (std::size_t row = 0; row < table.rows().size(); ++row) {
      const std::string& status = table.rows()[row][columns_.status];
      if (status != "refused" && status != "error") {
        passed_.rows.push_back(row);
        passed_.values.push_back(HasPassed(status) ? 1.0 : 0.0);
      }
    }
    for (const std::size_t column : columns_.parameters) {
      std::set<std::string> values;
      for (const std::size_t row : passed_.rows) {
        values.insert(table.rows()[row][column]);
      }
      if (values.size() > 1) {
        varied_.push_back(column);
      }
    }
  }

  [[nodiscard]] ordered_json Describe() const {
    const std::size_t count = passed_.rows.size();
    if (count < kMinRows) {
      return nullptr;
    }
    const auto passed =
        static_cast<std::size_t>(std::count(passed_.values.begin(), passed_.values.end(), 1.0));
    const Interval rate = WilsonInterval(passed, count, kConfidence);
    ordered_json json{
        {"rows", count},
        {"without_result", table_.rows().size() - count},
        {"pass_rate", Rounded(static_cast<double>(passed) / static_cast<double>(count))},
        {"pass_interval", IntervalJson(rate)}};
    json["outputs"] = ordered_json::array();
    for (const std::size_t column : columns_.outputs) {
      const Sample sample = SampleOf(column);
      if (sample.values.size() >= kMinRows) {
        ordered_json output = DescribeOutput(sample, /*is_rate=*/false);
        output["name"] = table_.columns()[column];
        json["outputs"].push_back(std::move(output));
      }
    }
    if (passed > 0 && passed < count) {
      ordered_json output = DescribeOutput(passed_, /*is_rate=*/true);
      output["name"] = "passed";
      json["outputs"].push_back(std::move(output));
    }
    json["correlations"] = Correlations();
    return json;
  }

 private:
  /// Computes the rank correlation of each pair of outputs, over the study rows that have values of
  /// both outputs.
  [[nodiscard]] ordered_json Correlations() const {
    ordered_json json = ordered_json::array();
    const std::size_t count = std::min(columns_.outputs.size(), kMaxCorrelatedOutputs);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const std::size_t a = columns_.outputs[j];
        const std::size_t b = columns_.outputs[i];
        std::vector<double> values_a;
        std::vector<double> values_b;
        for (const std::size_t row : passed_.rows) {
          const std::optional<double> value_a = CellNumber(table_.rows()[row][a]);
          const std::optional<double> value_b = CellNumber(table_.rows()[row][b]);
          if (value_a && value_b) {
            values_a.push_back(*value_a);
            values_b.push_back(*value_b);
          }
        }
        if (values_a.size() < kMinRows) {
          continue;
        }
        if (const auto correlation = CorrelateRanks(values_a, values_b, kConfidence)) {
          json.push_back({{"outputs", {table_.columns()[a], table_.columns()[b]}},
                          {"count", values_a.size()},
                          {"rho", Rounded(correlation->rho)},
                          {"interval", IntervalJson(correlation->interval)}});
        }
      }
    }
    return json;
  }

  [[nodiscard]] Sample SampleOf(std::size_t column) const {
    Sample sample;
    for (const std::size_t row : passed_.rows) {
      if (const std::optional<double> value = CellNumber(table_.rows()[row][column])) {
        sample.rows.push_back(row);
        sample.values.push_back(*value);
      }
    }
    return sample;
  }

  [[nodiscard]] std::vector<std::string> CellsOf(std::size_t column, const Sample& sample) const {
    std::vector<std::string> cells;
    for (const std::size_t row : sample.rows) {
      cells.push_back(table_.rows()[row][column]);
    }
    return cells;
  }

  [[nodiscard]] ordered_json DescribeOutput(const Sample& sample, bool is_rate) const {
    ordered_json json{{"count", sample.values.size()}};
    if (!is_rate) {
      const std::vector<double> shares{0.0, 0.01, 0.05, 0.25, 0.5, 0.75, 0.95, 0.99, 1.0};
      const std::vector<double> quantiles = Quantiles(sample.values, shares);
      for (std::size_t i = 0; i < shares.size(); ++i) {
        json["quantiles"].push_back({shares[i], Rounded(quantiles[i])});
      }
      std::vector<double> steps;
      const std::size_t points = std::min(kMaxStaircasePoints, sample.values.size());
      for (std::size_t i = 0; i < points; ++i) {
        steps.push_back(static_cast<double>(i) / static_cast<double>(points - 1));
      }
      const std::vector<double> staircase = Quantiles(sample.values, steps);
      for (std::size_t i = 0; i < points; ++i) {
        json["distribution"].push_back({Rounded(staircase[i]), Rounded(steps[i])});
      }
    }
    std::vector<Classes> classes;
    for (const std::size_t column : varied_) {
      classes.push_back(Classify(CellsOf(column, sample), ClassesFor(sample.values.size())));
    }
    const auto indices = FirstOrderIndices(classes, sample.values, {.confidence = kConfidence});
    json["indices"] = ordered_json::array();
    json["effects"] = ordered_json::array();
    for (std::size_t i = 0; i < varied_.size(); ++i) {
      if (indices[i]) {
        json["indices"].push_back({{"parameter", varied_[i]},
                                   {"index", Rounded(indices[i]->index)},
                                   {"interval", IntervalJson(indices[i]->interval)}});
      }
      json["effects"].push_back(
          {{"parameter", varied_[i]},
           {"classes",
            EffectsOf(Classify(CellsOf(varied_[i], sample), kMaxEffectClasses), sample, is_rate)}});
    }
    return json;
  }

  /// Computes the mean of an output in each class of a parameter.
  [[nodiscard]] static ordered_json EffectsOf(const Classes& classes, const Sample& sample,
                                              bool is_rate) {
    std::vector<std::vector<double>> values(classes.names.size());
    for (std::size_t i = 0; i < sample.values.size(); ++i) {
      values[classes.of_row[i]].push_back(sample.values[i]);
    }
    ordered_json json = ordered_json::array();
    for (std::size_t i = 0; i < std::min<std::size_t>(values.size(), 2 * kMaxEffectClasses); ++i) {
      const MeanEstimate mean = EstimateMean(values[i], kConfidence);
      const auto passed =
          static_cast<std::size_t>(std::count(values[i].begin(), values[i].end(), 1.0));
      const std::optional<Interval> interval =
          is_rate ? WilsonInterval(passed, values[i].size(), kConfidence) : mean.interval;
      const std::optional<double> number = CellNumber(classes.names[i]);
      json.push_back(
          {{"value", number ? ordered_json(Rounded(*number)) : ordered_json(classes.names[i])},
           {"count", values[i].size()},
           {"mean", Rounded(mean.mean)},
           {"interval", interval ? IntervalJson(*interval) : ordered_json()}});
    }
    return json;
  }

  const TextTable& table_;
  StudyColumns columns_;
  Sample passed_;                    // For each row of the study with a result: 1 if the run
                                     // passed, else 0.
  std::vector<std::size_t> varied_;  // Indices of the columns of the varied parameters.
};

}  // namespace

bool HasPassed(const std::string& status) {
  return status == "passed" || status == "found" || status == "passes_at_to";
}

ordered_json StudyStatistics(const TextTable& table) {
  return StudyAnalysis(table).Describe();
}

ShownRows StudyRowsToShow(const TextTable& table, std::size_t limit) {
  const std::size_t count = table.rows().size();
  ShownRows shown;
  for (std::size_t i = 0; i < std::min(count, limit); ++i) {
    shown.even.push_back(count <= limit ? i : i * count / limit);
  }
  std::set<std::size_t> extremes;
  if (count > limit) {
    for (const std::size_t column : StudyColumns(table).outputs) {
      std::vector<std::pair<double, std::size_t>> values;
      for (std::size_t row = 0; row < count; ++row) {
        if (const std::optional<double> value = CellNumber(table.rows()[row][column])) {
          values.emplace_back(*value, row);
        }
      }
      std::sort(values.begin(), values.end());
      for (std::size_t i = 0; i < std::min<std::size_t>(10, values.size()); ++i) {
        extremes.insert(values[i].second);
        extremes.insert(values[values.size() - 1 - i].second);
      }
    }
  }
  std::set_difference(extremes.begin(), extremes.end(), shown.even.begin(), shown.even.end(),
                      std::back_inserter(shown.extremes));
  return shown;
}

}  // namespace trackbed
