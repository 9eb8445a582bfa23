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

/// Reference to the variable that an option sets. The variable must outlive the parsing of the
/// command line. OptionTarget stores the address of the variable, so callers must not pass a copy.
using OptionTarget = std::variant<
    std::reference_wrapper<std::string>, std::reference_wrapper<int>,
    std::reference_wrapper<std::uint64_t>, std::reference_wrapper<double>,
    std::reference_wrapper<std::optional<std::string>>,
    std::reference_wrapper<std::optional<double>>, std::reference_wrapper<std::optional<int>>,
    std::reference_wrapper<std::vector<std::string>>, std::reference_wrapper<std::vector<double>>>;

/// Handle of a command line option. The handle is valid as long as the CommandLine exists.
class Option {
 public:
  Option Required() const;
  /// Sets the name of the option's value in help, such as FILE.
  Option TypeName(const std::string& name) const;
  /// Accepts several values in one word, separated by `separator`.
  Option Delimiter(char separator) const;
  /// Makes each occurrence of a list option take one word instead of all following words.
  Option OneWord() const;
  /// Shows the variable's current value as default in help.
  Option ShowDefault() const;
  Option Excludes(const Option& other) const;
  /// Makes this option an alternative to the required option `other`: exactly one of the two
  /// options must be given.
  Option InsteadOf(const Option& other) const;
  /// Rejects integers outside low..high.
  Option Range(int low, int high) const;
  /// Rejects numbers outside low..high, and NaN.
  Option Range(double low, double high) const;

 private:
  friend class Command;
  explicit Option(CLI::Option* option) : option_(option) {}

  CLI::Option* option_;
};

/// Describes an option or positional argument for the reference pages.
struct OptionInfo {
  std::string name;   ///< Names such as "-o,--out"; for a positional argument, its type name.
  std::string value;  ///< Type name; empty for flags and positional arguments.
  std::string text;
  std::string fallback;  ///< default value; empty if help shows none
  bool required = false;
  bool positional = false;
};

/// An example command shown in help.
struct Example {
  std::string text;     ///< Text on what the command does.
  std::string command;  ///< The command as typed.
};

/// Describes a verb for help and the reference pages.
struct CommandInfo {
  std::string name;
  std::string summary;
  std::vector<OptionInfo> options;  ///< options except --help and --color, which all verbs have
  std::vector<Example> examples;
};

class CommandLine;

/// Handle of a verb. The handle is valid as long as the CommandLine exists.
class Command {
 public:
  Option AddPositional(const std::string& name, OptionTarget target, const std::string& text) const;
  /// Adds an option; `names` lists its names, such as "-o,--out".
  Option AddOption(const std::string& names, OptionTarget target, const std::string& text) const;
  void AddFlag(const std::string& names, bool& target, const std::string& text) const;
  /// Adds a verb below this verb, such as "sweep merge". If the added verb is given, this verb is
  /// not run and requires no options.
  [[nodiscard]] Command AddVerb(const std::string& name, const std::string& summary) const;
  /// Adds an example to the end of the verb's help.
  void AddExample(const std::string& text, const std::string& command) const;
  /// Hides the verb from --help and VisibleVerbs.
  void Hide() const;
  /// Sets the action of the verb; `run` returns the exit code. Exceptions of `run` propagate
  /// through CommandLine::Parse.
  void OnRun(std::function<int()> run) const;
  /// Returns all verbs of the program that --help shows.
  [[nodiscard]] std::vector<CommandInfo> VisibleVerbs() const;

 private:
  friend class CommandLine;
  Command(CLI::App* app, CommandLine* line) : app_(app), line_(line) {}

  CLI::App* app_;
  CommandLine* line_;
};

/// Parses the command line of a program with verbs. Only command.cpp includes CLI11, whose headers
/// take longer to compile than the verbs.
class CommandLine {
 public:
  CommandLine(const std::string& name, const std::string& summary,
              std::function<std::string()> version);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  Command AddVerb(const std::string& name, const std::string& summary);

  /// Runs the verb that the command line names and returns the verb's exit code. Parse() also
  /// prints help, the version and errors of usage. Parse() returns `bad_usage` for an error of
  /// usage and if no verb is given.
  int Parse(int argc, char** argv, int bad_usage);

 private:
  friend class Command;
  /// Adds the options that all verbs have.
  void Prepare(CLI::App& verb);

  std::unique_ptr<CLI::App> app_;
  std::map<const CLI::App*, std::vector<Example>> examples_;
  int exit_code_ = 0;
};

}  // namespace trackbed::cli
