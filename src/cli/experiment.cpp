#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/cli/output_file.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/text_table.h"
#include "trackbed/sim/car_model.h"

// Repeats the experiment of Skackauskas et al. 2017. A primary car drives one lap at a constant
// steering angle. For a second car at another speed, a search finds the constant steering angle
// with which the second car ends at the same place as the primary car. The experiment runs every
// search method for every speed, with positions compared at equal times and at equal arc lengths.
// Finally, the experiment compares the steering angles that the searches found with the published
// angles.
namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOptimalSteering = "optimal_steering";
constexpr double kDegree = kPi / 180.0;

/// Options of the experiment. The defaults are the values of Skackauskas et al. 2017.
struct ExperimentOptions {
  std::string name;
  std::string vehicle = "prius";
  double steering = 10.0;      // Steering angle of the primary car [deg].
  double primary_speed = 3.0;  // Speed of the primary car [m/s].
  double max_steering = 27.0;  // Largest steering angle that a search may try [deg].
  std::vector<double> speeds{2.5, 2.0, 1.5, 1.0};  // Speeds of the second car [m/s].
  std::vector<std::string> searches;               // Search methods to run; empty: all.
  int evaluations = 0;
  std::uint64_t seed = 1;
  std::string out;
  bool quiet = false;
};

/// Returns the steering angle that the genetic algorithm found in the second stage of Skackauskas
/// et al. 2017. Published() returns nullopt if no steering angle was published for these options
/// and this speed. In the publication, the primary car steers 10 deg at 3 m/s. The published angles
/// differ from the primary car's 10 deg by at most 2.3 %.
std::optional<double> Published(const ExperimentOptions& options, double speed) {
  struct Row {
    double speed;    // [m/s]
    double degrees;  // [deg]
  };
  constexpr Row kPaper[] = {{2.5, 9.77}, {2.0, 9.94}, {1.5, 9.97}, {1.0, 10.03}};
  if (options.steering == 10.0 && options.primary_speed == 3.0) {
    for (const Row& row : kPaper) {
      if (row.speed == speed) {
        return row.degrees;
      }
    }
  }
  return std::nullopt;
}

constexpr double kPublishedScatter = 2.3;  // [%]

struct Match {
  double speed;  // [m/s]
  Matching matching;
  const SearchEntry* search;
  double steering;  // [deg]
  double cost;
  int evaluations;
};

const char* Name(Matching matching) {
  return matching == Matching::kTime ? "time" : "arc_length";
}

std::vector<const SearchEntry*> ChosenSearches(const std::vector<std::string>& chosen) {
  std::vector<std::string> names;
  for (const SearchEntry& entry : Searches()) {
    names.emplace_back(entry.name);
  }
  std::vector<const SearchEntry*> entries;
  for (const std::string& name : chosen.empty() ? names : chosen) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      throw InputError(
          Problem{.message = "--searches: unknown search " + UnknownName(name, names)});
    }
    entries.push_back(&Searches()[static_cast<std::size_t>(at - names.begin())]);
  }
  return entries;
}

/// Runs all searches and returns the results, ordered first by speed, then by the kind of matching
/// (at equal times, at equal arc lengths), then by search method.
std::vector<Match> MatchAll(const VehicleParams& vehicle, const ExperimentOptions& options,
                            const std::vector<const SearchEntry*>& searches) {
  std::vector<Match> matches;
  for (const double speed : options.speeds) {
    for (const Matching matching : {Matching::kTime, Matching::kArcLength}) {
      const CircleExperiment experiment{.primary_steering = options.steering * kDegree,
                                        .primary_speed = options.primary_speed,
                                        .speed = speed,
                                        .max_steering = options.max_steering * kDegree,
                                        .matching = matching};
      for (const SearchEntry* search : searches) {
        const SteeringMatch match = MatchSteering(
            vehicle, experiment, {.method = search->method, .evaluations = options.evaluations},
            options.seed);
        matches.push_back(
            {speed, matching, search, match.steering / kDegree, match.cost, match.evaluations});
      }
    }
  }
  return matches;
}

/// Returns the deviation of the found steering angle from the steering angle of the primary car
/// [%].
double Scatter(const ExperimentOptions& options, const Match& match) {
  return 100.0 * (match.steering / options.steering - 1.0);
}

std::string PublishedText(const ExperimentOptions& options, const Match& match,
                          const char* absent) {
  const auto published =
      match.matching == Matching::kArcLength ? Published(options, match.speed) : std::nullopt;
  return published ? ShortestText(*published) : absent;
}

TextTable EmptyTable() {
  return TextTable({"speed_mps", "matching", "search", "steering_deg", "off_primary_percent",
                    "cost", "evaluations", "published_deg"});
}

std::string ToCsv(const ExperimentOptions& options, const std::vector<Match>& matches) {
  TextTable table = EmptyTable();
  for (const Match& match : matches) {
    table.AddRow({ShortestText(match.speed), Name(match.matching), match.search->name,
                  ShortestText(match.steering), ShortestText(Scatter(options, match)),
                  ShortestText(match.cost), fmt::format("{}", match.evaluations),
                  PublishedText(options, match, "")});
  }
  return table.ToCsv();
}

/// Returns whether all steering angles that a search found at equal arc lengths scatter around the
/// primary car's angle at most as much as the published angles.
bool StaysWithin(const ExperimentOptions& options, const SearchEntry& search,
                 const std::vector<Match>& matches) {
  return std::all_of(matches.begin(), matches.end(), [&](const Match& match) {
    return match.search != &search || match.matching != Matching::kArcLength ||
           std::abs(Scatter(options, match)) <= kPublishedScatter;
  });
}

void PrintTable(const ExperimentOptions& options, const std::string& car,
                const std::vector<const SearchEntry*>& searches,
                const std::vector<Match>& matches) {
  Print("{}: the constant angle [deg] that brings {} where one lap at {} deg and {} m/s ends\n",
        kOptimalSteering, car, ShortestText(options.steering), ShortestText(options.primary_speed));
  std::string line = fmt::format("  {:>5} {:<10}", "[m/s]", "matched by");
  for (const SearchEntry* search : searches) {
    line += fmt::format(" {:>11}", search->name);
  }
  Print("{} {:>9}\n", line, "published");
  for (std::size_t i = 0; i < matches.size(); i += searches.size()) {
    line = fmt::format("  {:>5} {:<10}", ShortestText(matches[i].speed), Name(matches[i].matching));
    for (std::size_t j = i; j < i + searches.size(); ++j) {
      line += fmt::format(" {:>11.3f}", matches[j].steering);
    }
    Print("{} {:>9}\n", line, PublishedText(options, matches[i], "-"));
  }
  for (const bool within : {true, false}) {
    std::vector<const char*> names;
    for (const SearchEntry* search : searches) {
      if (StaysWithin(options, *search, matches) == within) {
        names.push_back(search->name);
      }
    }
    if (!names.empty()) {
      Print("  matched by arc length, {} {} % of the primary's angle: {}\n",
            within ? "always within" : "not always within", kPublishedScatter,
            fmt::format("{}", fmt::join(names, ", ")));
    }
  }
}

int Experiment(const ExperimentOptions& options) {
  if (options.name != kOptimalSteering) {
    throw InputError(
        Problem{.message = "unknown experiment " + UnknownName(options.name, {kOptimalSteering})});
  }
  const double steering = std::abs(options.steering);
  if (!(steering > 0.0 && steering <= options.max_steering)) {
    throw InputError(
        Problem{.message = fmt::format("--steering-deg: {} must not be 0, nor beyond the {} of "
                                       "--max-steering-deg",
                                       ShortestText(options.steering),
                                       ShortestText(options.max_steering))});
  }
  const std::vector<const SearchEntry*> searches = ChosenSearches(options.searches);
  const fs::path file = FindModel(options.vehicle, "");
  const CarModel car(ComposeScene(file, {}), file.string());
  if (!options.out.empty()) {
    PrepareOutputFile("--out", options.out, {file}, BeginsWith(EmptyTable().ToCsv()));
  }
  const std::vector<Match> matches = MatchAll(car.params(), options, searches);
  if (!options.out.empty()) {
    WriteFileAtomically(options.out, ToCsv(options, matches));
  }
  if (!options.quiet) {
    PrintTable(options, car.params().name, searches, matches);
  }
  return kOk;
}

}  // namespace

void AddExperiment(const Command& command) {
  const auto options = std::make_shared<ExperimentOptions>();
  command
      .AddPositional(
          "name", options->name,
          "optimal_steering: search for the steering angle that compensates a speed difference")
      .Required()
      .TypeName("NAME");
  command.AddOption("--vehicle", options->vehicle, "A model by name, or the path of an MJCF file")
      .TypeName("MODEL")
      .ShowDefault();
  command
      .AddOption("--steering-deg", options->steering,
                 "Steering angle of the reference motion (primary) [deg], positive to the left")
      .TypeName("DEG")
      .ShowDefault();
  command
      .AddOption("--primary-speed", options->primary_speed, "Speed of the reference motion [m/s]")
      .Range(0.1, 100.0)
      .TypeName("V")
      .ShowDefault();
  command
      .AddOption("--max-steering-deg", options->max_steering,
                 "Maximum steering angle of the search [deg]")
      .Range(0.1, 80.0)
      .TypeName("DEG")
      .ShowDefault();
  command
      .AddOption(
          "--speeds", options->speeds,
          "Speeds of the car that follows the reference (secondary) [m/s] (default: 2.5,2,1.5,1)")
      .Delimiter(',')
      .Range(0.01, 100.0)
      .TypeName("V,...");
  command
      .AddOption("--searches", options->searches,
                 "Optimizers; see 'trackbed list optimizers' (default: all)")
      .Delimiter(',')
      .TypeName("OPTIMIZER,...");
  command
      .AddOption("--evaluations", options->evaluations,
                 "Maximum evaluations per search; 0: each method's default")
      .Range(0, 100000000)
      .TypeName("N")
      .ShowDefault();
  command.AddOption("--seed", options->seed, "Seed of randomized searches")
      .TypeName("N")
      .ShowDefault();
  command.AddOption("-o,--out", options->out, "Also write the table as CSV").TypeName("FILE");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("One speed of the follower, all optimizers",
                     "trackbed experiment optimal_steering --speeds 2");
  command.OnRun([options] { return Experiment(*options); });
}

}  // namespace trackbed::cli
