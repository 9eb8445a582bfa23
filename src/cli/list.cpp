#include "src/cli/list.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "src/cli/scenario_options.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/avoidance/avoidance.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/render/film.h"
#include "trackbed/scenario/record.h"
#include "trackbed/sim/scene.h"

namespace trackbed::cli {
namespace {

struct Line {
  std::string name;
  std::string text;
};

struct Kind {
  const char* name;
  std::function<std::vector<Line>()> lines;
};

template <typename Table>
std::vector<Line> Summaries(const Table& table) {
  std::vector<Line> lines;
  for (const auto& entry : table) {
    lines.push_back({entry.name, entry.summary});
  }
  return lines;
}

void AddDefaults(const std::string& defaults, Line& line) {
  line.text += defaults.empty() ? "" : "; " + defaults;
}

std::vector<Line> Models() {
  std::vector<Line> lines;
  for (const std::string& name : ModelNames()) {
    lines.push_back({name, FindModel(name, "").string()});
  }
  return lines;
}

std::vector<Line> Scenarios() {
  std::vector<Line> lines;
  for (const auto& file : ShippedScenarios(FolderContent::kScenarios)) {
    lines.push_back({file.stem().string(), file.string()});
  }
  return lines;
}

std::vector<Line> Studies() {
  const std::vector<std::filesystem::path> scenarios = ShippedScenarios(FolderContent::kScenarios);
  std::vector<Line> lines;
  for (const auto& file : ShippedScenarios(FolderContent::kScenariosAndStudies)) {
    if (std::find(scenarios.begin(), scenarios.end(), file) == scenarios.end()) {
      lines.push_back({file.stem().string(), file.string()});
    }
  }
  return lines;
}

const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds{
      {"planners",
       [] {
         std::vector<Line> lines = Summaries(Planners());
         for (std::size_t i = 0; i < lines.size(); ++i) {
           AddDefaults(OptionDefaults(Planners()[i].defaults), lines[i]);
         }
         for (const AvoiderEntry& avoider : LocalPlanners()) {
           Line line{avoider.name, std::string(avoider.summary) + " (plan.avoid)"};
           AddDefaults(OptionDefaults(avoider.defaults), line);
           lines.push_back(line);
         }
         return lines;
       }},
      {"controllers",
       [] {
         std::vector<Line> lines = Summaries(Controllers());
         for (std::size_t i = 0; i < lines.size(); ++i) {
           AddDefaults(OptionDefaults(Controllers()[i].defaults), lines[i]);
         }
         return lines;
       }},
      {"maneuvers",
       [] {
         std::vector<Line> lines = Summaries(Maneuvers());
         for (std::size_t i = 0; i < lines.size(); ++i) {
           AddDefaults(OptionDefaults(Maneuvers()[i].defaults), lines[i]);
         }
         return lines;
       }},
      {"plants",
       [] {
         std::vector<Line> lines;
         for (const auto& [name, summary] : DrivenPlantSummaries()) {
           lines.push_back({name, summary});
         }
         return lines;
       }},
      {"optimizers", [] { return Summaries(Searches()); }},
      {"cameras", [] { return Summaries(Cameras()); }},
      {"overlays", [] { return Summaries(Overlays()); }},
      {"models", Models},
      {"scenarios", Scenarios},
      {"studies", Studies},
  };
  return kinds;
}

void PrintKind(const Kind& kind) {
  const std::vector<Line> lines = kind.lines();
  std::size_t longest = 18;
  for (const Line& line : lines) {
    longest = std::max(longest, SafeLine(line.name).size());
  }
  Print("{}:\n", Colorize(Tone::kHeading, kind.name));
  for (const Line& line : lines) {
    Print("  {:<{}} {}\n", line.name, longest, line.text);
  }
}

}  // namespace

std::vector<std::string> NamesOfKind(std::string_view name) {
  std::vector<std::string> names;
  for (const Kind& kind : Kinds()) {
    if (name == "kinds") {
      names.emplace_back(kind.name);
    } else if (kind.name == name) {
      for (const Line& line : kind.lines()) {
        names.push_back(line.name);
      }
    }
  }
  return names;
}

void AddList(const Command& command) {
  const auto what = std::make_shared<std::string>();
  std::string kinds;
  for (const std::string& kind : NamesOfKind("kinds")) {
    kinds += (kinds.empty() ? "" : ", ") + kind;
  }
  command.AddPositional("kind", *what, fmt::format("{} (default: all of them)", kinds))
      .TypeName("KIND");
  command.AddExample("Where shipped scenarios are", "trackbed list scenarios");
  command.OnRun([what] {
    std::vector<std::string> names;
    bool found = false;
    for (const Kind& kind : Kinds()) {
      names.emplace_back(kind.name);
      if (what->empty() || *what == kind.name) {
        PrintKind(kind);
        found = true;
      }
    }
    if (!found) {
      throw InputError(Problem{.message = "cannot list " + UnknownName(*what, names)});
    }
    return kOk;
  });
}

}  // namespace trackbed::cli
