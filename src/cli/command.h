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

/// Reference to the variable that a command line option sets. The variable must exist until the
/// command line has been parsed. OptionTarget stores the address of the variable, so callers must
/// pass the variable itself and not a copy.
using OptionTarget = std::variant<
    std::reference_wrapper<std::string>, std::reference_wrapper<int>,
    std::reference_wrapper<std::uint64_t>, std::reference_wrapper<double>,
    std::reference_wrapper<std::optional<std::string>>,
    std::reference_wrapper<std::optional<double>>, std::reference_wrapper<std::optional<int>>,
    std::reference_wrapper<std::vector<std::string>>, std::reference_wrapper<std::vector<double>>>;

/// Handle of a command line option. An option handle is valid as long as the CommandLine exists.
class Option {
 public:
  Option Required() const;
  /// Sets the name of the option's value in help, such as FILE.
  Option TypeName(const std::string& name) const;
  /// Accepts several option values in one word, separated by `separator`.
  Option Delimiter(char separator) const;
  /// Makes a list option take only the next word of the command line each time the option is given,
  /// instead of all following words.
  Option OneWord() const;
  /// Makes --help show the current value of the option's variable as the default.
  Option ShowDefault() const;
  Option Excludes(const Option& other) const;
  /// Makes this option an alternative to the required option `other`: exactly one of the two
  /// options must be given.
  Option InsteadOf(const Option& other) const;
  /// Makes the option reject integers less than `low` or greater than `high`.
  Option Range(int low, int high) const;
  /// Makes the option reject NaN and numbers less than `low` or greater than `high`.
  Option Range(double low, double high) const;

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}

  CLI::Option* option_;
};

/// Describes an option or positional argument for the reference pages.
struct OptionInfo {
  /// Names of the option, such as "-o,--out"; for a positional argument, the type name.
  std::string name;
  /// Type name of the option's value, such as FILE; empty for flags and positional arguments.
  std::string value;
  std::string text;
  std::string fallback;  ///< default value that help shows; empty if help shows no default
  bool required = false;
  bool positional = false;
};

/// An example command shown in help.
struct Example {
  std::string text;     ///< Explains what the command does.
  std::string command;  ///< The command as the user types it.
};

/// Describes a verb for help and the reference pages.
struct CommandInfo {
  std::string name;
  std::string summary;
  /// All options of the verb except --help and --color, which every verb has.
  std::vector<OptionInfo> options;
  std::vector<Example> examples;
};

class CommandLine;

/// Handle of a verb. A verb handle is valid as long as the CommandLine exists.
class Command {
 public:
  Option AddPositional(const std::string& name, OptionTarget target, const std::string& text) const;
  /// Adds a command line option; `names` lists its names, such as "-o,--out".
  Option AddOption(const std::string& names, OptionTarget target, const std::string& text) const;
  void AddFlag(const std::string& names, bool& target, const std::string& text) const;
  /// Adds a subcommand to this verb, as in "sweep merge". If the user gives the subcommand, the
  /// parent verb is not run and requires no options.
  [[nodiscard]] Command AddVerb(const std::string& name, const std::string& summary) const;
  /// Adds an example command to the end of the verb's help text.
  void AddExample(const std::string& text, const std::string& command) const;
  /// Makes --help and VisibleVerbs omit the verb.
  void Hide() const;
  /// Sets the function `run` that executes the verb and returns the exit code. CommandLine::Parse
  /// does not catch exceptions that `run` throws.
  void OnRun(std::function<int()> run) const;
  /// Returns descriptions of all verbs that --help shows.
  [[nodiscard]] std::vector<CommandInfo> VisibleVerbs() const;

 private:
  friend class CommandLine;
  Command(CLI::App* app, CommandLine* line) : app_(app), line_(line) {}

  CLI::App* app_;
  CommandLine* line_;
};

/// Parses the command line of a program with verbs. Only command.cpp includes CLI11, because the
/// headers of CLI11 take long to compile.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& summary,
              std::function<std::string()> version);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  Command AddVerb(const std::string& name, const std::string& summary);

  /// Runs the verb that the command line names and returns the verb's exit code. Parse() also
  /// prints the help, the version, or the reason why the command line is invalid. Parse() returns
  /// `bad_usage` if the command line is invalid or names no verb.
  int Parse(int argc, char** argv, int bad_usage);

 private:
  friend class Command;
  /// Adds the options common to all verbs, such as --color, to a verb.
  void Prepare(CLI::App& verb);

  std::unique_ptr<CLI::App> app_;
  std::map<const CLI::App*, std::vector<Example>> examples_;
  int exit_code_ = 0;
};

}  // namespace trackbed::cli
