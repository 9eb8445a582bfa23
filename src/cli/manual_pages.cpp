#include "src/cli/manual_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "src/cli/shell_pages.h"
#include "src/cli/shell_quote.h"
#include "trackbed/core/version.h"

// Writes roff text without a date, so that two builds of one version write the same pages.
namespace trackbed::cli {
namespace {

/// Escapes a text for a line of a manual page in roff format.
std::string Roff(const std::string& text) {
  const std::string escaped = Replaced(Replaced(text, "\\", "\\e"), "-", "\\-");
  return escaped.starts_with('.') || escaped.starts_with('\'') ? "\\&" + escaped : escaped;
}

std::string PageTitle(const std::string& name) {
  return fmt::format(".TH {} 1 \"\" \"Trackbed {}\" \"Trackbed\"\n", name, Version());
}

std::string PageOfVerb(const CommandInfo& verb) {
  const std::string name = "trackbed-" + Replaced(verb.name, " ", "-");
  std::string usage;
  for (const OptionInfo& option : verb.options) {
    if (option.positional) {
      usage += option.required ? " " + option.name : " [" + option.name + "]";
    }
  }
  std::string text = PageTitle(name);
  text += fmt::format(".SH NAME\n{} \\- {}\n", Roff(name), Roff(verb.summary));
  text += fmt::format(".SH SYNOPSIS\n.B trackbed {}\n[OPTION...]{}\n", verb.name, Roff(usage));
  text += ".SH OPTIONS\n";
  std::vector<OptionInfo> options = OptionsOf(verb);
  std::copy_if(verb.options.begin(), verb.options.end(), std::inserter(options, options.begin()),
               [](const OptionInfo& option) { return option.positional; });
  for (const OptionInfo& option : options) {
    const std::string names = Replaced(option.name, ",-", ", -");
    text += fmt::format(".TP\n\\fB{}\\fR{}\n{}{}\n", Roff(names),
                        option.value.empty() ? "" : " \\fI" + Roff(option.value) + "\\fR",
                        Roff(option.text),
                        option.fallback.empty() ? "" : " (default: " + Roff(option.fallback) + ")");
  }
  if (!verb.examples.empty()) {
    text += ".SH EXAMPLES\n";
  }
  for (const Example& example : verb.examples) {
    text += &example == &verb.examples.front() ? "" : ".PP\n";
    text += fmt::format("{}:\n.PP\n.RS 4\n.EX\n{}\n.EE\n.RE\n", Roff(example.text),
                        Roff(example.command));
  }
  return text + ".SH SEE ALSO\n.BR trackbed (1)\n";
}

}  // namespace

std::vector<ManualPage> ManualPages(const std::vector<CommandInfo>& verbs) {
  std::string text = PageTitle("trackbed");
  text +=
      ".SH NAME\ntrackbed \\- vehicle simulation testbed on MuJoCo\n"
      ".SH SYNOPSIS\n.B trackbed\nVERB [OPTION...]\n"
      ".SH DESCRIPTION\nRuns plans and controllers under contact dynamics, compares them with a "
      "kinematic model, and renders videos without a display.\n"
      ".SH VERBS\n";
  std::vector<ManualPage> pages;
  for (const CommandInfo& verb : verbs) {
    ManualPage page{"trackbed-" + Replaced(verb.name, " ", "-") + ".1", PageOfVerb(verb)};
    text += fmt::format(".TP\n\\fB{}\\fR\n{}; see \\fB{}\\fR(1)\n", verb.name, Roff(verb.summary),
                        Roff(page.file.substr(0, page.file.size() - 2)));
    pages.push_back(std::move(page));
  }
  text +=
      ".SH EXIT STATUS\n"
      ".TP\n0\nDone; of runs with expectations: all met.\n"
      ".TP\n1\nA bug in Trackbed.\n"
      ".TP\n2\nWrong input, or an environment that does not allow the work.\n"
      ".TP\n3\nExpectations or tolerances not met.\n"
      ".TP\n130\nInterrupted; what was finished is kept.\n"
      ".SH ENVIRONMENT\n"
      ".TP\nTRACKBED_DATA\nFolder with models and scenarios, instead of the installed one.\n"
      ".TP\nNO_COLOR\nIf set and not empty: no colors.\n";
  pages.insert(pages.begin(), {"trackbed.1", text});
  return pages;
}

}  // namespace trackbed::cli
