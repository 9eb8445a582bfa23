#include "src/cli/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "src/cli/terminal.h"

// Implements the command line with the library CLI11: the class Command wraps a CLI11 app, and the
// class Option wraps a CLI11 option. CommandLine prints help in the usual layout, wrapped to the
// width of the terminal. CommandLine also adds the option --color to every verb, and shortens
// CLI11's messages for missing arguments. VisibleVerbs describes all verbs for the shell
// completion, the manual pages and the reference page.
namespace trackbed::cli {

Option Option::Required() const {
  option_->required();
  return *this;
}

Option Option::TypeName(const std::string& name) const {
  option_->type_name(name);
  return *this;
}

Option Option::Delimiter(char separator) const {
  option_->delimiter(separator);
  return *this;
}

Option Option::OneWord() const {
  option_->allow_extra_args(false);
  return *this;
}

Option Option::ShowDefault() const {
  option_->capture_default_str();
  return *this;
}

Option Option::Excludes(const Option& other) const {
  option_->excludes(other.option_);
  return *this;
}

Option Option::InsteadOf(const Option& other) const {
  option_->excludes(other.option_);
  option_->each(
      [replaced = other.option_](const std::string& /*value*/) { replaced->required(false); });
  return *this;
}

Option Option::Range(int low, int high) const {
  option_->check(CLI::Range(low, high).description(""));
  return *this;
}

Option Option::Range(double low, double high) const {
  // Do not use CLI::Range here, because CLI::Range accepts NaN.
  option_->check(CLI::Validator(
      [low, high](std::string& text) {
        double value = 0.0;
        const bool good = CLI::detail::lexical_cast(text, value) && value >= low && value <= high;
        return good ? "" : fmt::format("{} is not a number from {} to {}", text, low, high);
      },
      ""));
  return *this;
}

Option Command::AddPositional(const std::string& name, OptionTarget target,
                              const std::string& text) const {
  return AddOption(name, target, text);
}

Option Command::AddOption(const std::string& names, OptionTarget target,
                          const std::string& text) const {
  return Option(std::visit(
      [&](auto variable) { return app_->add_option(names, variable.get(), text); }, target));
}

void Command::AddFlag(const std::string& names, bool& target, const std::string& text) const {
  app_->add_flag(names, target, text);
}

void Command::Hide() const {
  app_->group("");
}

void Command::OnRun(std::function<int()> run) const {
  app_->callback([run = std::move(run), code = &line_->exit_code_, app = app_] {
    if (app->get_subcommands().empty()) {
      *code = run();
    }
  });
}

namespace {

OptionInfo Info(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const bool positional = option.get_positional();
  return {.name = positional ? type : option.get_name(false, true),
          .value = !positional && option.get_items_expected_max() > 0 ? type : "",
          .text = option.get_description(),
          .fallback = option.get_default_str(),
          .required = option.get_required(),
          .positional = positional};
}

}  // namespace

Command Command::AddVerb(const std::string& name, const std::string& summary) const {
  CLI::App* verb = app_->add_subcommand(name, summary);
  line_->Prepare(*verb);
  return {verb, line_};
}

namespace {

constexpr const char* kColorOption = "--color";

/// Appends the verbs of `app` and, recursively, their subcommands to `verbs`. The text `before`
/// precedes the name of each verb.
void AddVisibleVerbs(const CLI::App& app, const std::string& before,
                     const std::map<const CLI::App*, std::vector<Example>>& examples,
                     std::vector<CommandInfo>& verbs) {
  const auto is_visible = [](const CLI::App* verb) { return !verb->get_group().empty(); };
  for (const CLI::App* verb : app.get_subcommands(is_visible)) {
    CommandInfo info{before + verb->get_name(), verb->get_description(), {}, {}};
    for (const CLI::Option* option : verb->get_options()) {
      if (option != verb->get_help_ptr() && !option->check_name(kColorOption)) {
        info.options.push_back(Info(*option));
      }
    }
    if (const auto found = examples.find(verb); found != examples.end()) {
      info.examples = found->second;
    }
    verbs.push_back(std::move(info));
    AddVisibleVerbs(*verb, verb->get_name() + " ", examples, verbs);
  }
}

}  // namespace

std::vector<CommandInfo> Command::VisibleVerbs() const {
  std::vector<CommandInfo> verbs;
  AddVisibleVerbs(*line_->app_, "", line_->examples_, verbs);
  return verbs;
}

void Command::AddExample(const std::string& text, const std::string& command) const {
  std::vector<Example>& examples = line_->examples_[app_];
  examples.push_back({text, command});
  std::string footer = "Examples:\n";
  for (const Example& example : examples) {
    footer += fmt::format("  {}:\n    {}\n", example.text, example.command);
  }
  app_->footer(footer);
}

namespace {

/// Returns the message "missing FILE" or "missing --speed SPEED" for the first required argument or
/// option that the user did not give.
std::optional<std::string> Missing(const CLI::App& program) {
  for (const CLI::App* verb : program.get_subcommands()) {
    for (const CLI::Option* option : verb->get_options()) {
      if (option->get_required() && option->count() == 0) {
        const OptionInfo info = Info(*option);
        const std::string name = info.name.substr(0, info.name.find('.'));
        return "missing " + name + (info.value.empty() ? "" : " " + info.value);
      }
    }
    if (std::optional<std::string> below = Missing(*verb)) {
      return below;
    }
  }
  return std::nullopt;
}

}  // namespace

namespace {

/// Formats help texts: value names are printed as given, and text is wrapped to the terminal's
/// width.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option(const CLI::Option* option, bool positional) const override {
    const OptionInfo info = Info(*option);
    std::string text = info.text;
    text += info.fallback.empty() ? "" : fmt::format(" (default: {})", info.fallback);
    return Item(positional ? info.name : info.name + (info.value.empty() ? "" : " " + info.value),
                text);
  }

  std::string make_option_usage(const CLI::Option* option) const override {
    const std::string name = Info(*option).name;
    return option->get_required() ? name : "[" + name + "]";
  }

  std::string make_subcommand(const CLI::App* verb) const override {
    return Item(verb->get_name(), verb->get_description());
  }

  std::string make_description(const CLI::App* app) const override {
    std::string text;
    for (const std::string& line : Wrapped(app->get_description(), Width())) {
      text += line + "\n";
    }
    return text + "\n";
  }

 private:
  /// Returns the width of help texts, at most 100 columns, because longer lines are hard to read.
  static std::size_t Width() { return std::min<std::size_t>(TerminalWidth(), 100); }

  static std::string Item(const std::string& name, const std::string& text) {
    constexpr std::size_t kIndent = 2;
    constexpr std::size_t kColumn = 26;
    std::string item = std::string(kIndent, ' ') + name;
    const std::vector<std::string> lines = Wrapped(text, Width() - kColumn);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const bool beside = i == 0 && item.size() + 2 <= kColumn;
      item += beside ? std::string(kColumn - item.size(), ' ') : "\n" + std::string(kColumn, ' ');
      item += lines[i];
    }
    return item + "\n";
  }
};

}  // namespace

CommandLine::CommandLine(const std::string& name, const std::string& summary,
                         std::function<std::string()> version)
    : app_(std::make_unique<CLI::App>(summary, name)) {
  app_->set_version_flag("--version", std::move(version));
  app_->set_help_flag("-h,--help", "Print this help");
  app_->require_subcommand(0, 1);
  app_->failure_message(CLI::FailureMessage::simple);
  app_->formatter(std::make_shared<HelpFormatter>());
  app_->get_formatter()->label("OPTIONS", "OPTION...");
  app_->get_formatter()->label("SUBCOMMAND", "VERB");
  app_->get_formatter()->label("Positionals", "Arguments");
  Prepare(*app_);
}

CommandLine::~CommandLine() = default;

Command CommandLine::AddVerb(const std::string& name, const std::string& summary) {
  CLI::App* verb = app_->add_subcommand(name, summary);
  Prepare(*verb);
  return {verb, this};
}

void CommandLine::Prepare(CLI::App& verb) {
  verb.group("Verbs");
  verb.footer("");  // removes the footer that the verb would otherwise inherit from its parent verb
  verb.add_option_function<std::string>(kColorOption, &ChooseColors,
                                        "Colors: auto (on a terminal, unless NO_COLOR is set), "
                                        "always or never")
      ->check(CLI::IsMember(ColorChoices()).description(""))
      ->type_name("auto|always|never")
      ->trigger_on_parse();
}

namespace {

/// If the command line names a verb and one of its subcommands, makes the required options of the
/// parent verb optional. If the parent's arguments remained required, CLI11 would use the
/// subcommand's name as the value of an argument.
void RequireOnlyOfLowestVerb(CLI::App& program, int argc, char** argv) {
  const auto find = [](CLI::App& app, const char* name) {
    return app.get_subcommands([&](const CLI::App* verb) { return verb->check_name(name); });
  };
  for (CLI::App* verb : argc > 2 ? find(program, argv[1]) : std::vector<CLI::App*>()) {
    if (!find(*verb, argv[2]).empty()) {
      for (CLI::Option* option : verb->get_options([](const CLI::Option*) { return true; })) {
        option->required(false);
      }
    }
  }
}

}  // namespace

int CommandLine::Parse(int argc, char** argv, int bad_usage) {
  RequireOnlyOfLowestVerb(*app_, argc, argv);
  try {
    app_->parse(argc, argv);
  } catch (const CLI::RequiredError& error) {
    PrintTo(stderr, "{}\nRun with --help for more information.\n",
            Missing(*app_).value_or(error.what()));
    return bad_usage;
  } catch (const CLI::ParseError& error) {
    std::ostringstream out;
    std::ostringstream said;
    const int code = app_->exit(error, out, said);
    Print("{}", Lines{out.str()});
    PrintTo(stderr, "{}", Lines{said.str()});
    return code == 0 ? 0 : bad_usage;
  }
  if (app_->get_subcommands().empty()) {
    Print("{}", Lines{app_->help()});
    return bad_usage;
  }
  return exit_code_;
}

}  // namespace trackbed::cli
