#include "trackbed/scenario/study_reader.h"

#include <algorithm>
#include <sstream>

#include "src/scenario/derived_keys.h"
#include "src/scenario/study_settings.h"
#include "src/scenario/study_visit.h"
#include "src/scenario/variation_reader.h"
#include "src/scenario/yaml_file.h"
#include "src/scenario/yaml_value.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"

// Reads a study file. The reader visits the keys of the study (study_visit.h); callbacks read the
// sections whose keys are keys of a scenario (variation_reader.cpp). Finally, the reader checks
// rules that concern several keys of the study. For example, a condition may use only keys that are
// set before the condition, and no setting may overwrite an earlier setting. All problems are
// collected and reported in the order of the file.
namespace trackbed {
namespace {

constexpr double kMaxRuns = 1e7;

class StudyReader {
 public:
  StudyReader(const std::filesystem::path& file, const YAML::Node& root,
              const std::vector<std::filesystem::path>& asset_folders)
      : folders_{file.parent_path(), asset_folders}, root_(root), context_{.file = file.string()} {}

  Study Read() {
    StudyFile file;
    Study& study = file.study;
    file.set = [&](const YAML::Node& node, const std::string& key) {
      study.set = ReadSettings(node, key);
    };
    file.vary = [&](const YAML::Node& node, const std::string& key) { ReadVary(node, key, study); };
    file.nominal = [&](const YAML::Node& node, const std::string& key) {
      study.nominal = ReadSettings(node, key);
    };
    file.list = [&](const YAML::Node& node, const std::string& key) { ReadList(node, key, study); };
    file.outputs = [&](const YAML::Node& node, const std::string& key) {
      ReadOutputs(node, key, study);
    };
    file.derive = [&](const YAML::Node& node, const std::string& key) {
      ReadDerived(node, key, study);
    };
    YamlReader reader(context_, root_, "");
    Visit(reader, file);
    reader.Finish();
    if (root_["sample"]) {
      study.sample = file.sample;
    }
    if (root_["search"]) {
      study.search = file.search;
    }
    study.file = context_.file;
    study.keep = ReadKeep(file.keep, study);
    ReadBaseScenario(file.scenario, study);
    SetBisection(file.bisect, study);
    if (context_.problems.empty()) {
      CheckStudy(study);
    }
    context_.ThrowProblems();
    return std::move(file.study);
  }

 private:
  void AddError(const YAML::Node& node, const std::string& key, std::string message) {
    context_.AddError(node.Mark(), key, std::move(message));
  }
  void AddError(const Setting& at, std::string message) {
    context_.problems.push_back({context_.file, at.line, at.column, at.key, std::move(message)});
  }

  std::vector<Setting> ReadSettings(const YAML::Node& node, const std::string& section) {
    std::vector<Setting> settings;
    ForEachKey(context_, node, section,
               [&](const YAML::Node& key, const YAML::Node& value, const auto&) {
                 settings.push_back(ParseSetting(key.Scalar(), value));
               });
    return settings;
  }

  void ReadVary(const YAML::Node& node, const std::string& section, Study& study) {
    ForEachKey(
        context_, node, section,
        [&](const YAML::Node& key, const YAML::Node& value, const std::string& dotted) {
          study.vary.push_back(ReadVariation(context_, folders_, key.Scalar(), value, dotted));
        });
  }

  void ReadList(const YAML::Node& node, const std::string& section, Study& study) {
    if (!node.IsSequence() || node.size() == 0) {
      AddError(node, section,
               fmt::format("expected a list of points, found {}",
                           node.IsSequence() ? "an empty one" : DescribeValue(node)));
      return;
    }
    for (std::size_t i = 0; i < node.size(); ++i) {
      study.list.push_back(ReadSettings(node[i], fmt::format("{}[{}]", section, i)));
    }
  }

  void ReadDerived(const YAML::Node& node, const std::string& section, Study& study) {
    ForEachKey(context_, node, section,
               [&](const YAML::Node& key, const YAML::Node& value, const std::string& dotted) {
                 if (!value.IsScalar() || value.Scalar().empty()) {
                   AddError(value, dotted,
                            fmt::format("expected a formula, found {}", DescribeValue(value)));
                   return;
                 }
                 study.derive.push_back({key.Scalar(), value.Scalar(), value.Mark().line + 1,
                                         value.Mark().column + 1});
               });
  }

  void ReadOutputs(const YAML::Node& node, const std::string& section, Study& study) {
    if (!node.IsSequence()) {
      AddError(node, section,
               fmt::format("expected a list of names, found {}", DescribeValue(node)));
      return;
    }
    for (std::size_t i = 0; i < node.size(); ++i) {
      const YAML::Node item = node[i];
      const std::string key = fmt::format("{}[{}]", section, i);
      const auto is_same_path = [&](const OutputSpec& other) {
        return other.path == item.Scalar();
      };
      if (!item.IsScalar() || item.Scalar().empty()) {
        AddError(item, key, fmt::format("expected a name, found {}", DescribeValue(item)));
      } else if (std::any_of(study.outputs.begin(), study.outputs.end(), is_same_path)) {
        AddError(item, key, fmt::format("'{}' is listed twice", item.Scalar()));
      } else {
        study.outputs.push_back({item.Scalar(), item.Mark().line + 1, item.Mark().column + 1});
      }
    }
  }

  KeepSpec ReadKeep(const std::string& text, const Study& study) {
    using Rows = KeepSpec::Rows;
    const auto refuse = [&](std::string message) {
      AddError(root_["keep"], "keep", std::move(message));
      return KeepSpec{};
    };
    for (const Rows rows : {Rows::kNone, Rows::kFailed, Rows::kAll}) {
      if (text == ToString(KeepSpec{.rows = rows})) {
        return rows != Rows::kNone && root_["bisect"]
                   ? refuse("a row of a bisection has many runs; give none, or leave out bisect")
                   : KeepSpec{.rows = rows};
      }
    }
    std::istringstream words(text);
    std::string kind;
    std::string by;
    KeepSpec keep;
    words >> kind >> keep.count >> by >> keep.by;
    if ((kind != "worst" && kind != "lowest") || by != "by" || keep.by.empty() || !words.eof()) {
      return refuse(
          fmt::format("'{}' is not understood; give none, failed, all, worst N by OUTPUT "
                      "or lowest N by OUTPUT",
                      text));
    }
    if (keep.count < 1 || keep.count > 1000) {
      return refuse(fmt::format("{} rows; must be from 1 to 1000", keep.count));
    }
    Names outputs;
    for (const OutputSpec& output : study.outputs) {
      outputs.push_back(output.path);
    }
    if (outputs.empty()) {
      return refuse(
          fmt::format("'{}' must be one of the study's outputs, and it has none", keep.by));
    }
    if (std::find(outputs.begin(), outputs.end(), keep.by) == outputs.end()) {
      return refuse("no output " + UnknownName(keep.by, outputs));
    }
    if (root_["bisect"]) {
      return refuse("a row of a bisection has many runs; give none, or leave out bisect");
    }
    keep.rows = kind == "worst" ? Rows::kHighest : Rows::kLowest;
    return keep;
  }

  void ReadBaseScenario(const std::string& name, Study& study) {
    if (name.empty()) {
      return;
    }
    study.scenario = folders_.own / name;
    try {
      study.scenario_text = ReadInput(study.scenario);
    } catch (const InputError& error) {
      AddError(root_["scenario"], "scenario", error.problems().front().message);
    }
  }

  void SetBisection(const BisectSpec& bisect, Study& study) {
    const YAML::Node node = root_["bisect"];
    if (bisect.key.empty() || !context_.problems.empty()) {
      return;
    }
    study.bisect = bisect;
    study.bisect->line = node.Mark().line + 1;
    study.bisect->column = node.Mark().column + 1;
    CheckEnds(context_, node, "bisect", bisect.from, bisect.to);
  }

  void CheckStudy(const Study& study) {
    const bool varies = root_["vary"] || root_["list"] || root_["repeat"] || root_["bisect"];
    const bool is_sampled =
        std::any_of(study.vary.begin(), study.vary.end(),
                    [](const Variation& variation) { return variation.distribution.has_value(); });
    if (is_sampled && !study.sample && !study.search) {
      AddError(root_["vary"], "sample", "missing; keys of vary have distributions");
    }
    if (!is_sampled && study.sample) {
      AddError(root_["sample"], "sample", "no key of vary has a distribution");
    }
    if (!is_sampled && study.search) {
      AddError(root_["search"], "search", "no key of vary has a distribution");
    }
    if (study.search) {
      CheckSearch(study);
    }
    for (const Setting& setting : study.nominal) {
      if (!study.search) {
        AddError(setting, "is for a search; the study has no `search`");
      }
    }
    if (!varies) {
      AddError(root_, "vary", "missing; a study needs vary, list, repeat or bisect");
    }
    auto runs = static_cast<double>(study.repeat);
    for (const Variation& variation : study.vary) {
      runs *= variation.distribution ? 1.0 : static_cast<double>(variation.alternatives.size());
    }
    runs *= static_cast<double>(std::max<std::size_t>(study.list.size(), 1));
    runs *= study.sample ? study.sample->count : 1.0;
    if (runs > kMaxRuns) {
      AddError(root_, "vary", fmt::format("{} runs; at most {}", runs, kMaxRuns));
    }
    CheckConditions(study);
    CheckUniqueSettings(study);
    CheckSeed(study);
    if (context_.problems.empty()) {
      CheckFormulas(study);
    }
  }

  /// Rejects varied keys of a study that the search method does not support.
  void CheckSearch(const Study& study) {
    const SearchSpec& search = *study.search;
    const YAML::Node node = root_["search"];
    const auto is_one_of = [&](const Names& methods) {
      return std::find(methods.begin(), methods.end(), search.method) != methods.end();
    };
    const auto refuse = [&](const char* key, const std::string& message) {
      AddError(node[key] ? node[key] : node, fmt::format("search.{}", key), message);
    };
    const auto keys = static_cast<int>(study.vary.size());
    const bool has_none = is_one_of({"random", "latin_hypercube", "sobol", "surrogate"});
    if (has_none && search.restarts > 0) {
      refuse("restarts", fmt::format("{} has none; leave it out", search.method));
    }
    if (has_none && search.finish != "none") {
      refuse("finish", fmt::format("goes on from searches of NLopt, not from {}", search.method));
    }
    if (search.population > 0 && !is_one_of({"crs2", "esch", "isres"})) {
      refuse("population", fmt::format("{} has none; leave it out", search.method));
    }
    if (search.population > 0 && search.population < keys + 2) {
      refuse("population",
             fmt::format("{} for {} keys; at least {}", search.population, keys, keys + 2));
    }
    if (search.method == "direct" && search.restarts > 1) {
      refuse("restarts", "direct does the same each time; 1 at most");
    }
    // Require enough runs for about three rounds of the search method DIRECT. The first round of
    // DIRECT evaluates the center of the search space and two points for each key.
    if (search.method == "direct" && search.runs < 4 * (2 * keys + 1)) {
      refuse("runs", fmt::format("{} for direct and {} keys; at least {}", search.runs, keys,
                                 4 * (2 * keys + 1)));
    }
  }

  /// Checks that each condition of a study uses only keys set before the condition, and that no key
  /// of the grid depends on a sampled key.
  void CheckConditions(const Study& study) {
    Names of_grid;
    for (const Setting& setting : study.set) {
      of_grid.push_back(setting.key);
    }
    for (const auto& point : study.list) {
      for (const Setting& setting : point) {
        of_grid.push_back(setting.key);
      }
    }
    Names sampled;
    for (const Variation& variation : study.vary) {
      for (const Condition& condition : variation.when) {
        Names known = of_grid;
        if (variation.distribution) {
          known.insert(known.end(), sampled.begin(), sampled.end());
        }
        if (std::find(known.begin(), known.end(), condition.key) == known.end()) {
          const bool is_sampled =
              std::find(sampled.begin(), sampled.end(), condition.key) != sampled.end();
          context_.problems.push_back(
              {context_.file, variation.line, variation.column,
               fmt::format("vary.{}.when", variation.key),
               is_sampled
                   ? fmt::format("{} is sampled, so that a key of the grid cannot depend on it",
                                 condition.key)
                   : "a key that the study does not set before: " +
                         UnknownName(condition.key, known)});
        }
      }
      (variation.distribution ? sampled : of_grid).push_back(variation.key);
    }
  }

  /// Checks that a study sets each key only once and that no setting overwrites an earlier setting.
  void CheckUniqueSettings(const Study& study) {
    std::vector<Setting> single_settings;
    for (const Variation& variation : study.vary) {
      single_settings.push_back({variation.key, "", variation.line, variation.column});
    }
    for (const DerivedKey& derived : study.derive) {
      single_settings.push_back({derived.key, "", derived.line, derived.column});
    }
    const std::vector<std::vector<Setting>> points =
        study.list.empty() ? std::vector<std::vector<Setting>>(1) : study.list;
    for (const std::vector<Setting>& point : points) {
      std::vector<Setting> settings = single_settings;
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

  StudyFolders folders_;
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
                const MetricPaths& metrics,
                const std::vector<std::filesystem::path>& asset_folders) {
  const YAML::Node root = LoadYaml(ReadInput(file), file.string(), "a study");
  if (!root["scenario"] && root["mission"]) {
    throw InputError(Problem{.file = file.string(),
                             .key = "scenario",
                             .message = "missing: the file is a scenario; a study names it, and "
                                        "the values to run it with"});
  }
  Study study = StudyReader(file, root, asset_folders).Read();
  study.overrides = overrides;
  study.metrics = metrics;
  study.asset_folders = asset_folders;
  return study;
}

}  // namespace trackbed
