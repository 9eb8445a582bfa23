#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace trackbed::cli {

/// The variable that an option sets; it must outlive the parsing. Pass the variable itself.
using OptionTarget = std::variant<
    std::reference_wrapper<std::string>, std::reference_wrapper<int>,
    std::reference_wrapper<std::uint64_t>, std::reference_wrapper<double>,
    std::reference_wrapper<std::optional<std::string>>,
    std::reference_wrapper<std::optional<double>>, std::reference_wrapper<std::optional<int>>,
    std::reference_wrapper<std::vector<std::string>>, std::reference_wrapper<std::vector<double>>>;

/// Handle of an option that a Command has; valid as long as its CommandLine.
class Option {
 public:
  Option Required() const;
  /// What help shows for the value, such as FILE.
  Option TypeName(const std::string& name) const;
  /// Values may be given in one word, separated by it.
  Option Delimiter(char separator) const;
  /// A list takes one word each time the option is given, not all that follow.
  Option OneWord() const;
  /// Help shows the value that the variable has now.
  Option ShowDefault() const;
  Option Excludes(const Option& other) const;
  /// Excludes it, and then it is not required either.
  Option InsteadOf(const Option& other) const;
  /// Refuses integers outside low..high.
  Option Range(int low, int high) const;
  /// Refuses numbers outside low..high, and NaN.
  Option Range(double low, double high) const;

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}

  CLI::Option* option_;
};

/// An option or positional argument as the reference pages show it.
struct OptionInfo {
  std::string name;   ///< "-o,--out"; of a positional argument its type name
  std::string value;  ///< type name of the option's value; empty of flags and positional arguments
  std::string text;
  std::string fallback;  ///< default, empty if none is shown
  bool required = false;
  bool positional = false;
};

/// A command that help shows.
struct Example {
  std::string text;     ///< what it does
  std::string command;  ///< as one types it
};

/// A verb as help and the reference pages show it.
struct CommandInfo {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;  ///< without --help and --color, which every verb has
  std::vector<Example> examples;
};

class CommandLine;

/// Handle of one verb of a CommandLine, which must outlive it.
class Command {
 public:
  Option AddPositional(const std::string& name, OptionTarget target, const std::string& text) const;
  /// `names` as in "-o,--out".
  Option AddOption(const std::string& names, OptionTarget target, const std::string& text) const;
  void AddFlag(const std::string& names, bool& target, const std::string& text) const;
  /// A verb below this one ("sweep merge"), which is then not run itself and requires nothing.
  [[nodiscard]] Command AddVerb(const std::string& name, const std::string& summary) const;
  /// Shown at the end of --help.
  void AddExample(const std::string& text, const std::string& command) const;
  /// Leaves the verb out of --help and of VisibleVerbs.
  void Hide() const;
  /// Sets what the verb does; `run` gives back the exit code. Its exceptions leave
  /// CommandLine::Parse.
  void OnRun(std::function<int()> run) const;
  /// All verbs of the program that --help shows.
  [[nodiscard]] std::vector<CommandInfo> VisibleVerbs() const;

 private:
  friend class CommandLine;
  Command(CLI::App* app, CommandLine* line) : app_(app), line_(line) {}

  CLI::App* app_;
  CommandLine* line_;
};

/// The parser of a program with verbs. Everything that knows CLI11, whose headers take longer to
/// compile than the verbs themselves, is in command.cpp.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& summary,
              std::function<std::string()> version);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  Command AddVerb(const std::string& name, const std::string& summary);

  /// Runs the verb that the words ask for and gives back its exit code. Prints help, the version or
  /// what is wrong with the words; `bad_usage` is the exit code then, and without a verb.
  int Parse(int argc, char** argv, int bad_usage);

 private:
  friend class Command;
  /// Adds what every verb has.
  void Prepare(CLI::App& verb);

  std::unique_ptr<CLI::App> app_;
  std::map<const CLI::App*, std::vector<Example>> examples_;
  int exit_code_ = 0;
};

}  // namespace trackbed::cli
