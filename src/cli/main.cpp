#include "trackbed/cli/main.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "src/cli/interruption.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/core/method_error.h"
#include "trackbed/core/spelling.h"
#include "trackbed/core/version.h"
#include "trackbed/optimize/search.h"
#include "trackbed/render/film.h"
#include "trackbed/sim/car_model.h"

namespace trackbed::cli {

namespace {

struct Verb {
  const char* name;
  const char* summary;
  AddVerb add;
};

const std::vector<Verb> kVerbs{
    {"run", "Plan, simulate and measure scenarios; write a run folder for each", AddRun},
    {"plan", "Plan only: write the path, its steering schedule and the planner's diagnostics",
     AddPlan},
    {"render", "Render the video of a finished run from its folder", AddRender},
    {"import", "Make a run folder of the log of a real vehicle", AddImport},
    {"identify", "Estimate numbers of a vehicle model from recorded drives", AddIdentify},
    {"compare", "Compare plants on one plan, or two finished runs", AddCompare},
    {"test", "Run scenarios and check their expectations, one line each", AddTest},
    {"check", "Validate scenarios and studies without running them", AddCheck},
    {"check-path", "Check whether a car can drive the path in a file, and how fast", AddCheckPath},
    {"sweep", "Run a study: one scenario over many parameter values, results in one table",
     AddSweep},
    {"falsify", "Search a study for a run that fails, and make it as small as it gets", AddFalsify},
    {"verify", "Run a sample of a study until it is known whether enough of it passes", AddVerify},
    {"report", "Write one HTML page about finished runs or a study", AddReport},
    {"watch", "Show a run in a browser while it goes on, or a finished run", AddWatch},
    {"fmu", "Export the car of a scenario as a co-simulation unit (FMI 2 or 3)", AddFmu},
    {"experiment", "Repeat a published experiment and print its table", AddExperiment},
    {"list",
     "List available planners, controllers, maneuvers, plants, optimizers, cameras, overlays, "
     "models, scenarios or studies",
     AddList},
    {"model", "Print the parameters of a vehicle model, or write its composed MJCF", AddModel},
    {"completion", "Print a script that completes commands in a shell", AddCompletion},
    {"docs", "Update the generated tables of docs/cli.md", AddDocs},
    {"man", "Write manual pages", AddManual},
};

std::string VersionText() {
  return fmt::format("Trackbed {}\n{}\n{}\nvideo {}", Version(), PhysicsVersion(),
                     OptimizerVersion(), VideoEncoder());
}

/// Rejects the option --import, which only the program of the Python package accepts. The Python
/// program removes --import from the command line before it calls Main.
void RejectImport(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--import" || argument.starts_with("--import=")) {
      throw InputError(Problem{
          .key = "--import",
          .message = "this program contains no Python; install the Python package (`pip install .` "
                     "in the source tree) and call `python3 -m trackbed` with the same arguments"});
    }
  }
}

int Run(int argc, char** argv) {
  RejectImport(argc, argv);
  CommandLine line("trackbed",
                   "Vehicle simulation testbed on MuJoCo: runs plans and controllers under contact "
                   "dynamics, compares them with a kinematic model, and renders videos off-screen.",
                   VersionText);
  for (const Verb& verb : kVerbs) {
    verb.add(line.AddVerb(verb.name, verb.summary));
  }
  // Report an unknown verb before CLI11 parses the command line, because CLI11 would report an
  // unexpected argument instead of an unknown verb.
  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> names;
    bool known = false;
    for (const Verb& verb : kVerbs) {
      names.emplace_back(verb.name);
      known = known || names.back() == argv[1];
    }
    if (!known) {
      throw InputError(Problem{.message = "unknown verb " + UnknownName(argv[1], names)});
    }
  }
  return line.Parse(argc, argv, kBadInput);
}

}  // namespace
}  // namespace trackbed::cli

namespace trackbed {

namespace {

/// Opens /dev/null for each closed standard stream. If a standard stream stayed closed, the next
/// opened file would get the stream's file descriptor. Output for the closed stream would then be
/// written into the opened file. The file /dev/null is opened for reading only, so writing to a
/// stream that was closed still fails.
void OccupyClosedStreams() {
  int descriptor = 0;
  do {
    descriptor = ::open("/dev/null", O_RDONLY);
  } while (descriptor >= 0 && descriptor <= STDERR_FILENO);
  if (descriptor > STDERR_FILENO) {
    ::close(descriptor);
  }
}

}  // namespace

int Main(int argc, char** argv) {
  OccupyClosedStreams();
  cli::EndOnSignals();
  std::signal(SIGPIPE, SIG_IGN);
  // Print the error message with plain stdio, which does not throw if stderr is closed.
  const auto say = [](const std::string& text) {
    const cli::SafeText shown = cli::Colorize(cli::Tone::kBad, cli::Lines{text}, stderr);
    std::fputs((shown.text + "\n").c_str(), stderr);
  };
  int code = cli::kInternal;
  try {
    code = cli::Run(argc, argv);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
      throw RunError("cannot write to standard output");
    }
  } catch (const InputError& error) {
    say(error.what());
    code = cli::kBadInput;
  } catch (const RunError& error) {
    say(error.what());
    code = cli::interrupted ? cli::kInterrupted : cli::kBadInput;
  } catch (const MethodError& error) {
    say(error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    say("cannot access " + error.path1().string() + ": " + error.code().message());
    code = cli::interrupted ? cli::kInterrupted : cli::kBadInput;
  } catch (const std::system_error& error) {
    // If fmt throws because stdout cannot be written, print the same error message as for a failed
    // flush of stdout.
    say(std::ferror(stdout) != 0 ? "cannot write to standard output" : error.what());
    code = cli::interrupted ? cli::kInterrupted : cli::kBadInput;
  } catch (const std::exception& error) {
    say(std::string("internal error: ") + error.what());
  }
  return code;
}

}  // namespace trackbed
