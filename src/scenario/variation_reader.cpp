#include "src/scenario/variation_reader.h"

#include <algorithm>
#include <cmath>

#include "src/scenario/study_visit.h"
#include "src/scenario/yaml_value.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"

// Reads one entry of the section `vary` of a study. An entry of the section `vary` is a list of
// values, a section {values, when}, a range {from, to, steps, scale}, or a distribution with its
// parameters. The values of a varied key are stored as single-line YAML text (flow style), because
// a study applies the values as overrides of a scenario. A range {from, to, steps, scale} is
// converted to a list of values with 15 significant digits. If an entry names a column of a CSV
// file, each value of the key is chosen randomly among the cells of the column.
namespace trackbed {
namespace {

/// Writes a YAML value as text on one line, and keeps the quotes around texts.
void WriteFlow(const YAML::Node& node, YAML::Emitter& out) {
  if (node.IsMap()) {
    out << YAML::Flow << YAML::BeginMap;
    for (const auto& entry : node) {
      out << YAML::Key;
      WriteFlow(entry.first, out);
      out << YAML::Value;
      WriteFlow(entry.second, out);
    }
    out << YAML::EndMap;
  } else if (node.IsSequence()) {
    out << YAML::Flow << YAML::BeginSeq;
    for (const auto& item : node) {
      WriteFlow(item, out);
    }
    out << YAML::EndSeq;
  } else if (node.IsScalar()) {
    if (node.Tag() == "!") {
      out << YAML::DoubleQuoted;
    }
    out << node.Scalar();
  } else {
    out << YAML::Null;
  }
}

/// Formats value i of a range with 15 digits, so that a tenth is printed as 0.1 and not as
/// 0.10000000000000002.
std::string GridValue(const GridRange& range, int i) {
  const int last = range.steps - 1;
  if (i == 0 || i == last) {
    return ShortestText(i == 0 ? range.from : range.to);
  }
  const double share = static_cast<double>(i) / last;
  const double value = range.scale == GridScale::kLog
                           ? range.from * std::pow(range.to / range.from, share)
                           : (range.from * (last - i) + range.to * i) / last;
  return fmt::format("{:.15g}", value);
}

class VariationReader {
 public:
  VariationReader(ReaderContext& context, const StudyFolders& folders)
      : context_(context), folders_(folders) {}

  Variation Read(const std::string& key, const YAML::Node& node, const std::string& dotted) {
    Variation variation{.key = key, .line = node.Mark().line + 1, .column = node.Mark().column + 1};
    if (!node.IsMap()) {
      variation.alternatives = ReadValues(key, node, dotted);
    } else if (node["distribution"]) {
      ReadDistribution(node, dotted, variation);
    } else if (node["values"]) {
      WithCondition(node, dotted, variation, [&](YamlReader& reader) {
        reader.Custom({"values", "", "of the key"}, "list", [&](const YAML::Node& values, auto at) {
          variation.alternatives = ReadValues(key, values, at);
        });
      });
    } else {
      ReadRange(node, dotted, variation);
    }
    if (!variation.alternatives.empty()) {
      variation.line = variation.alternatives.front().line;
      variation.column = variation.alternatives.front().column;
    }
    return variation;
  }

 private:
  void AddError(const YAML::Node& node, const std::string& key, std::string message) {
    context_.AddError(node.Mark(), key, std::move(message));
  }

  /// Reads a section that has the keys which `visit` declares, and also the key `when`.
  void WithCondition(const YAML::Node& node, const std::string& dotted, Variation& variation,
                     const std::function<void(YamlReader& reader)>& visit) {
    YamlReader reader(context_, node, dotted);
    visit(reader);
    reader.Custom({"when", "", "values of other keys"}, "section",
                  [&](const YAML::Node& conditions, const std::string& at) {
                    variation.when = ReadConditions(conditions, at);
                  });
    reader.Finish();
  }

  std::vector<Condition> ReadConditions(const YAML::Node& node, const std::string& section) {
    std::vector<Condition> conditions;
    ForEachKey(context_, node, section,
               [&](const YAML::Node& key, const YAML::Node& value, const std::string& /*dotted*/) {
                 Condition condition{key.Scalar(), {}};
                 if (value.IsSequence()) {
                   for (const auto& one : value) {
                     condition.values.push_back(ParseSetting("", one).value);
                   }
                 } else {
                   condition.values.push_back(ParseSetting("", value).value);
                 }
                 conditions.push_back(std::move(condition));
               });
    return conditions;
  }

  void ReadDistribution(const YAML::Node& node, const std::string& dotted, Variation& variation) {
    const std::size_t before = context_.problems.size();
    Distribution distribution;
    TableColumn table;
    bool is_of_file = false;
    WithCondition(node, dotted, variation, [&](YamlReader& reader) {
      std::vector<std::string> names{kFileDistribution};
      for (const auto& [kind, name] : DistributionNames()) {
        names.emplace_back(name);
      }
      std::string name;
      reader.Field({"distribution", "", "of the values"}, name, Need::kRequired, names);
      for (const auto& [kind, known] : DistributionNames()) {
        distribution.kind = name == known ? kind : distribution.kind;
      }
      is_of_file = name == kFileDistribution;
      if (is_of_file) {
        Visit(reader, table);
        distribution.kind = DistributionKind::kChoice;
        return;
      }
      if (distribution.kind == DistributionKind::kChoice) {
        reader.Custom({"values", "", "to choose from"}, "list",
                      [&](const YAML::Node& values, const std::string& at) {
                        for (Setting& value : ReadValues(variation.key, values, at)) {
                          distribution.values.push_back(std::move(value.value));
                        }
                      });
      }
      Visit(reader, distribution);
    });
    if (context_.problems.size() > before) {
      return;
    }
    if (is_of_file) {
      ReadColumn(node, dotted, table, distribution);
      variation.rows_of = table.file;
    } else {
      CheckDistribution(node, dotted, distribution);
    }
    variation.distribution = std::move(distribution);
  }

  void CheckDistribution(const YAML::Node& node, const std::string& dotted,
                         const Distribution& distribution) {
    switch (distribution.kind) {
      case DistributionKind::kUniform:
      case DistributionKind::kLogUniform:
      case DistributionKind::kInteger:
        CheckEnds(context_, node, dotted, distribution.from, distribution.to);
        if (distribution.kind == DistributionKind::kLogUniform && distribution.from <= 0.0) {
          AddError(node["from"], dotted + ".from", "must be above 0 for a logarithm");
        }
        if (distribution.step > 0.0 && distribution.from < distribution.to) {
          const double steps = (distribution.to - distribution.from) / distribution.step;
          // Allow a tolerance in the count of steps, because decimal fractions such as 0.2 have
          // rounding errors.
          if (std::round(steps) < 1.0 || std::abs(steps - std::round(steps)) > 1e-9 * steps) {
            AddError(node["step"], dotted + ".step",
                     fmt::format("{} to {} is no whole number of steps of {}", distribution.from,
                                 distribution.to, distribution.step));
          }
        }
        if (distribution.kind == DistributionKind::kInteger) {
          for (const char* end : {"from", "to"}) {
            const double value =
                end == std::string_view("to") ? distribution.to : distribution.from;
            if (value != std::floor(value)) {
              AddError(node[end], dotted + "." + end, fmt::format("{} is no whole number", value));
            }
          }
        }
        break;
      case DistributionKind::kNormal:
        if (!(distribution.min < distribution.max)) {
          AddError(node["min"], dotted + ".min",
                   fmt::format("{} must be below max: {}", distribution.min, distribution.max));
        }
        break;
      case DistributionKind::kChoice:
        if (distribution.values.empty()) {
          AddError(node, dotted + ".values", "missing");
        } else if (!distribution.weights.empty() &&
                   distribution.weights.size() != distribution.values.size()) {
          AddError(node["weights"], dotted + ".weights",
                   fmt::format("{} weights of {} values", distribution.weights.size(),
                               distribution.values.size()));
        } else if (!distribution.weights.empty() &&
                   std::all_of(distribution.weights.begin(), distribution.weights.end(),
                               [](double weight) { return weight == 0.0; })) {
          AddError(node["weights"], dotted + ".weights", "all are 0");
        }
        break;
    }
  }

  /// Reads the cells of a CSV column; a random sample later chooses values among these cells.
  void ReadColumn(const YAML::Node& node, const std::string& dotted, const TableColumn& column,
                  Distribution& distribution) {
    if (const std::string why = ReadAccessError(column.file, folders_.own, folders_.others);
        !why.empty()) {
      AddError(node["file"], dotted + ".file", column.file + " " + why);
      return;
    }
    try {
      const TextTable table = ReadTextCsv(folders_.own / column.file);
      const auto found = std::find(table.columns().begin(), table.columns().end(), column.column);
      if (found == table.columns().end()) {
        AddError(node["column"], dotted + ".column",
                 "no column " + UnknownName(column.column, table.columns()));
        return;
      }
      const auto index = static_cast<std::size_t>(found - table.columns().begin());
      for (const std::vector<std::string>& row : table.rows()) {
        distribution.values.push_back(row[index]);
      }
      if (distribution.values.empty()) {
        AddError(node["file"], dotted + ".file", "the table has no rows");
      }
    } catch (const InputError& error) {
      context_.problems.insert(context_.problems.end(), error.problems().begin(),
                               error.problems().end());
    } catch (const RunError& error) {
      AddError(node["file"], dotted + ".file", error.what());
    }
  }

  std::vector<Setting> ReadValues(const std::string& key, const YAML::Node& node,
                                  const std::string& dotted) {
    std::vector<Setting> values;
    if (!node.IsSequence() || node.size() == 0) {
      AddError(node, dotted,
               fmt::format("expected a list of values, or {{from, to, steps}}, found {}",
                           node.IsSequence() ? "an empty list" : DescribeValue(node)));
      return values;
    }
    for (const auto& value : node) {
      values.push_back(ParseSetting(key, value));
    }
    return values;
  }

  void ReadRange(const YAML::Node& node, const std::string& dotted, Variation& variation) {
    const std::size_t before = context_.problems.size();
    GridRange range;
    WithCondition(node, dotted, variation, [&](YamlReader& reader) { Visit(reader, range); });
    if (context_.problems.size() > before) {
      return;
    }
    CheckEnds(context_, node, dotted, range.from, range.to);
    if (range.scale == GridScale::kLog && range.from <= 0.0) {
      AddError(node["from"], dotted + ".from", "must be above 0 for a geometric scale");
    }
    for (int i = 0; i < range.steps; ++i) {
      variation.alternatives.push_back(
          {variation.key, GridValue(range, i), variation.line, variation.column});
    }
  }

  ReaderContext& context_;
  const StudyFolders& folders_;
};

}  // namespace

Setting ParseSetting(const std::string& key, const YAML::Node& value) {
  YAML::Emitter out;
  WriteFlow(value, out);
  return {key, out.c_str(), value.Mark().line + 1, value.Mark().column + 1};
}

void ForEachKey(ReaderContext& context, const YAML::Node& node, const std::string& section,
                const ReadEntry& read) {
  if (!node.IsMap() || node.size() == 0) {
    context.AddError(node.Mark(), section,
                     fmt::format("expected a section of scenario keys, found {}",
                                 node.IsMap() ? "an empty one" : DescribeValue(node)));
    return;
  }
  std::vector<std::string> seen;
  for (const auto& entry : node) {
    if (!entry.first.IsScalar() || entry.first.Scalar().empty()) {
      context.AddError(entry.first.Mark(), section, "keys must be names");
      continue;
    }
    const std::string& key = entry.first.Scalar();
    const std::string dotted = section + "." + key;
    if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
      context.AddError(entry.first.Mark(), dotted, "duplicate key");
    } else if (key.find('=') != std::string::npos) {
      context.AddError(entry.first.Mark(), dotted, "a key must not contain '='");
    } else if (entry.second.IsNull()) {
      context.AddError(entry.first.Mark(), dotted, "expected a value, found nothing");
    } else {
      read(entry.first, entry.second, dotted);
    }
    seen.push_back(key);
  }
}

void CheckEnds(ReaderContext& context, const YAML::Node& node, const std::string& dotted,
               double from, double to) {
  if (!(from < to)) {
    context.AddError(node["from"].Mark(), dotted + ".from",
                     fmt::format("{} must be below to: {}", from, to));
  }
}

Variation ReadVariation(ReaderContext& context, const StudyFolders& folders, const std::string& key,
                        const YAML::Node& node, const std::string& dotted) {
  return VariationReader(context, folders).Read(key, node, dotted);
}

}  // namespace trackbed
