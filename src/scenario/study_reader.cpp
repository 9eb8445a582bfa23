#include <algorithm>
#include <cmath>

#include "src/scenario/study_settings.h"
#include "src/scenario/study_visit.h"
#include "src/scenario/yaml_file.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study.h"

namespace trackbed {
namespace {

constexpr std::size_t kMaxRuns = 100000;

/// Writes a value as it was read, on one line: what stood in quotes keeps them.
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

Setting ParseSetting(const std::string& key, const YAML::Node& value) {
  YAML::Emitter out;
  WriteFlow(value, out);
  return {key, out.c_str(), value.Mark().line + 1, value.Mark().column + 1};
}

/// The grid's values to 15 digits, so that a tenth is 0.1 and not 0.10000000000000002.
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

class StudyReader {
 public:
  StudyReader(const std::filesystem::path& file, const YAML::Node& root)
      : folder_(file.parent_path()), root_(root), context_{.file = file.string()} {}

  Study Read() {
    StudyFile file;
    Study& study = file.study;
    file.set = [&](const YAML::Node& node, const std::string& key) {
      study.set = ReadSettings(node, key);
    };
    file.vary = [&](const YAML::Node& node, const std::string& key) { ReadVary(node, key, study); };
    file.list = [&](const YAML::Node& node, const std::string& key) { ReadList(node, key, study); };
    file.outputs = [&](const YAML::Node& node, const std::string& key) {
      ReadOutputs(node, key, study);
    };
    YamlReader reader(context_, root_, "");
    Visit(reader, file);
    reader.Finish();
    study.file = context_.file;
    ReadBaseScenario(file.scenario, study);
    TakeBisect(file.bisect, study);
    if (context_.problems.empty()) {
      CheckStudy(study);
    }
    if (!context_.problems.empty()) {
      std::stable_sort(context_.problems.begin(), context_.problems.end(),
                       [](const Problem& a, const Problem& b) {
                         return std::pair(a.line, a.column) < std::pair(b.line, b.column);
                       });
      throw InputError(context_.problems);
    }
    return std::move(file.study);
  }

 private:
  void AddError(const YAML::Node& node, const std::string& key, std::string message) {
    context_.AddError(node.Mark(), key, std::move(message));
  }
  void AddError(const Setting& at, std::string message) {
    context_.problems.push_back({context_.file, at.line, at.column, at.key, std::move(message)});
  }

  using ReadEntry = std::function<void(const YAML::Node& key, const YAML::Node& value,
                                       const std::string& dotted)>;

  /// Calls with each key of a section of keys of the scenario's, and its value.
  void ForEachKey(const YAML::Node& node, const std::string& section, const ReadEntry& read) {
    if (!node.IsMap() || node.size() == 0) {
      AddError(node, section,
               fmt::format("expected a section of scenario keys, found {}",
                           node.IsMap() ? "an empty one" : YamlReader::Describe(node)));
      return;
    }
    Names seen;
    for (const auto& entry : node) {
      if (!entry.first.IsScalar() || entry.first.Scalar().empty()) {
        AddError(entry.first, section, "keys must be names");
        continue;
      }
      const std::string& key = entry.first.Scalar();
      const std::string dotted = section + "." + key;
      if (std::find(seen.begin(), seen.end(), key) != seen.end()) {
        AddError(entry.first, dotted, "duplicate key");
      } else if (key.find('=') != std::string::npos) {
        AddError(entry.first, dotted, "a key must not contain '='");
      } else if (entry.second.IsNull()) {
        AddError(entry.first, dotted, "expected a value, found nothing");
      } else {
        read(entry.first, entry.second, dotted);
      }
      seen.push_back(key);
    }
  }

  std::vector<Setting> ReadSettings(const YAML::Node& node, const std::string& section) {
    std::vector<Setting> settings;
    ForEachKey(node, section, [&](const YAML::Node& key, const YAML::Node& value, const auto&) {
      settings.push_back(ParseSetting(key.Scalar(), value));
    });
    return settings;
  }

  void ReadVary(const YAML::Node& node, const std::string& section, Study& study) {
    ForEachKey(node, section,
               [&](const YAML::Node& key, const YAML::Node& value, const std::string& dotted) {
                 study.vary.push_back(value.IsMap() ? ReadRange(key.Scalar(), value, dotted)
                                                    : ReadValues(key.Scalar(), value, dotted));
               });
  }

  std::vector<Setting> ReadValues(const std::string& key, const YAML::Node& node,
                                  const std::string& dotted) {
    std::vector<Setting> values;
    if (!node.IsSequence() || node.size() == 0) {
      AddError(node, dotted,
               fmt::format("expected a list of values, or {{from, to, steps}}, found {}",
                           node.IsSequence() ? "an empty list" : YamlReader::Describe(node)));
      return values;
    }
    for (const auto& value : node) {
      values.push_back(ParseSetting(key, value));
    }
    return values;
  }

  std::vector<Setting> ReadRange(const std::string& key, const YAML::Node& node,
                                 const std::string& dotted) {
    const std::size_t before = context_.problems.size();
    GridRange range;
    YamlReader reader(context_, node, dotted);
    Visit(reader, range);
    reader.Finish();
    std::vector<Setting> values;
    if (context_.problems.size() > before) {
      return values;
    }
    CheckEnds(node, dotted, range.from, range.to);
    if (range.scale == GridScale::kLog && range.from <= 0.0) {
      AddError(node["from"], dotted + ".from", "must be above 0 for a geometric scale");
    }
    for (int i = 0; i < range.steps; ++i) {
      values.push_back({key, GridValue(range, i), node.Mark().line + 1, node.Mark().column + 1});
    }
    return values;
  }

  void CheckEnds(const YAML::Node& node, const std::string& dotted, double from, double to) {
    if (!(from < to)) {
      AddError(node["from"], dotted + ".from", fmt::format("{} must be below to: {}", from, to));
    }
  }

  void ReadList(const YAML::Node& node, const std::string& section, Study& study) {
    if (!node.IsSequence() || node.size() == 0) {
      AddError(node, section,
               fmt::format("expected a list of points, found {}",
                           node.IsSequence() ? "an empty one" : YamlReader::Describe(node)));
      return;
    }
    for (std::size_t i = 0; i < node.size(); ++i) {
      study.list.push_back(ReadSettings(node[i], fmt::format("{}[{}]", section, i)));
    }
  }

  void ReadOutputs(const YAML::Node& node, const std::string& section, Study& study) {
    if (!node.IsSequence()) {
      AddError(node, section,
               fmt::format("expected a list of names, found {}", YamlReader::Describe(node)));
      return;
    }
    for (std::size_t i = 0; i < node.size(); ++i) {
      const YAML::Node item = node[i];
      const std::string key = fmt::format("{}[{}]", section, i);
      const auto is_it = [&](const OutputSpec& other) { return other.path == item.Scalar(); };
      if (!item.IsScalar() || item.Scalar().empty()) {
        AddError(item, key, fmt::format("expected a name, found {}", YamlReader::Describe(item)));
      } else if (std::any_of(study.outputs.begin(), study.outputs.end(), is_it)) {
        AddError(item, key, fmt::format("'{}' is listed twice", item.Scalar()));
      } else {
        study.outputs.push_back({item.Scalar(), item.Mark().line + 1, item.Mark().column + 1});
      }
    }
  }

  void ReadBaseScenario(const std::string& name, Study& study) {
    if (name.empty()) {
      return;
    }
    study.scenario = folder_ / name;
    try {
      study.scenario_text = ReadInput(study.scenario);
    } catch (const InputError& error) {
      AddError(root_["scenario"], "scenario", error.problems().front().message);
    }
  }

  void TakeBisect(const BisectSpec& bisect, Study& study) {
    const YAML::Node node = root_["bisect"];
    if (bisect.key.empty() || !context_.problems.empty()) {
      return;
    }
    study.bisect = bisect;
    study.bisect->line = node.Mark().line + 1;
    study.bisect->column = node.Mark().column + 1;
    CheckEnds(node, "bisect", bisect.from, bisect.to);
  }

  void CheckStudy(const Study& study) {
    const bool varies = root_["vary"] || root_["list"] || root_["repeat"] || root_["bisect"];
    if (!varies) {
      AddError(root_, "vary", "missing; a study needs vary, list, repeat or bisect");
    }
    auto runs = static_cast<double>(study.repeat);
    for (const auto& alternatives : study.vary) {
      runs *= static_cast<double>(alternatives.size());
    }
    runs *= static_cast<double>(std::max<std::size_t>(study.list.size(), 1));
    if (runs > static_cast<double>(kMaxRuns)) {
      AddError(root_, "vary", fmt::format("{} runs; at most {}", runs, kMaxRuns));
    }
    CheckWhatReplaces(study);
    CheckSeed(study);
  }

  /// Every key must be set once, and nothing may be set that is then replaced.
  void CheckWhatReplaces(const Study& study) {
    std::vector<Setting> one_of_each;
    for (const auto& alternatives : study.vary) {
      one_of_each.push_back(alternatives.front());
    }
    const std::vector<std::vector<Setting>> points =
        study.list.empty() ? std::vector<std::vector<Setting>>(1) : study.list;
    for (const std::vector<Setting>& point : points) {
      std::vector<Setting> settings = one_of_each;
      settings.insert(settings.end(), point.begin(), point.end());
      settings = AllSettings(study, settings,
                             study.bisect ? std::optional(study.bisect->from) : std::nullopt);
      for (auto later = settings.begin(); later != settings.end(); ++later) {
        const auto earlier = std::find_if(settings.begin(), later, [&](const Setting& setting) {
          return Replaces(later->key, setting.key);
        });
        if (earlier != later) {
          AddErrorOnce(*later,
                       fmt::format("overwrites {}, set in line {}", earlier->key, earlier->line));
        }
      }
    }
  }

  void CheckSeed(const Study& study) {
    for (const Setting& setting : Varied(study)) {
      if (study.repeat > 1 && setting.key == "seed") {
        AddErrorOnce(setting, "cannot be varied together with repeat, which sets the seed");
      }
    }
  }

  void AddErrorOnce(const Setting& at, const std::string& message) {
    const bool known = std::any_of(
        context_.problems.begin(), context_.problems.end(), [&](const Problem& problem) {
          return problem.line == at.line && problem.column == at.column &&
                 problem.message == message;
        });
    if (!known) {
      AddError(at, message);
    }
  }

  std::filesystem::path folder_;
  const YAML::Node root_;
  ReaderContext context_;
};

}  // namespace

bool IsStudy(const std::filesystem::path& file) {
  try {
    const YAML::Node root = LoadYaml(ReadInput(file), file.string());
    return static_cast<bool>(root["scenario"]);
  } catch (const InputError&) {
    return false;
  }
}

Study ReadStudy(const std::filesystem::path& file, const std::vector<Override>& overrides,
                const std::vector<std::string>& cameras, const MetricPaths& metrics,
                const std::vector<std::filesystem::path>& asset_folders) {
  Study study = StudyReader(file, LoadYaml(ReadInput(file), file.string(), "a study")).Read();
  study.overrides = overrides;
  study.cameras = cameras;
  study.metrics = metrics;
  study.asset_folders = asset_folders;
  return study;
}

}  // namespace trackbed
