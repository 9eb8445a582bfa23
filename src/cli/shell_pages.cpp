#include "src/cli/shell_pages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>
#include <string_view>

#include "src/cli/list.h"
#include "src/cli/shell_quote.h"

// Writes completion scripts for bash, zsh and fish from the options of the verbs.
// 1. CommandInfo lists verbs, subcommands, options and positional arguments, as the command line
//    parser defines them.
// 2. The type name of an option determines the values offered for completion. A type name such as
//    "draft|film" lists the values itself. For the type names CAMERA and SCENARIO, the completion
//    script runs `trackbed list`.
// 3. Each shell parses words differently, so each shell has its own quoting function. Names of
//    files and scenarios are untrusted data, and are never inserted into the code of a completion
//    script.
namespace trackbed::cli {
namespace {

using Words = std::vector<std::string>;

const OptionInfo kHelp{.name = "-h,--help", .text = "Print help"};
const OptionInfo kColor{.name = "--color", .value = "auto|always|never", .text = "Colors"};

Words PartsOf(const std::string& text, char separator) {
  Words words;
  std::istringstream in(text);
  for (std::string word; std::getline(in, word, separator);) {
    words.push_back(word);
  }
  return words;
}

/// Returns the possible values of an option from the name of its value type. A type name such as
/// "draft|film" is itself the list of the possible values. The type names "CAMERA", "CAMERA,..."
/// and "SCENARIO..." are kinds of names that `trackbed list` prints. For all other type names,
/// ValuesOf returns an empty list.
Words ValuesOf(const std::string& type) {
  if (type.find('|') != std::string::npos) {
    return PartsOf(type, '|');
  }
  std::string kind;
  for (const char c : type) {
    if (std::isupper(static_cast<unsigned char>(c)) == 0) {
      break;
    }
    kind += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  if (kind == "study") {
    return NamesOfKind("studies");
  }
  return NamesOfKind(kind + "s");
}

bool IsList(const std::string& type) {
  return type.ends_with(",...");
}

}  // namespace

std::vector<OptionInfo> OptionsOf(const CommandInfo& verb) {
  std::vector<OptionInfo> options;
  for (const OptionInfo& option : verb.options) {
    if (!option.positional) {
      options.push_back(option);
    }
  }
  options.push_back(kColor);
  options.push_back(kHelp);
  return options;
}

namespace {

/// Returns the possible values of the verb's positional arguments.
Words PositionalValues(const CommandInfo& verb) {
  Words values;
  for (const OptionInfo& option : verb.options) {
    if (option.positional) {
      const Words some = ValuesOf(option.name);
      values.insert(values.end(), some.begin(), some.end());
    }
  }
  return values;
}

/// Returns the direct subcommands of the verb `above`, each named by its last word. If `above` is
/// empty, returns the top-level verbs of the program.
std::vector<CommandInfo> VerbsBelow(const std::vector<CommandInfo>& verbs,
                                    const std::string& above) {
  std::vector<CommandInfo> below;
  for (CommandInfo verb : verbs) {
    const std::size_t space = verb.name.rfind(' ');
    const std::string parent = space == std::string::npos ? "" : verb.name.substr(0, space);
    if (parent == above) {
      verb.name = verb.name.substr(space == std::string::npos ? 0 : space + 1);
      below.push_back(std::move(verb));
    }
  }
  return below;
}

Words NamesOf(const std::vector<CommandInfo>& verbs) {
  Words names;
  for (const CommandInfo& verb : verbs) {
    names.push_back(verb.name);
  }
  return names;
}

/// Quotes a text that Trackbed itself defines, such as a help text, for bash and zsh.
std::string QuotedText(const std::string& text) {
  return QuotedForSh(text).value();
}

/// Returns the words other than options that may follow a verb: values of positional arguments, and
/// the names of the verb's subcommands.
Words PositionalWords(const std::vector<CommandInfo>& verbs, const CommandInfo& verb) {
  Words words = PositionalValues(verb);
  for (const std::string& below : NamesOf(VerbsBelow(verbs, verb.name))) {
    words.push_back(below);
  }
  return words;
}

}  // namespace

std::string BashCompletion(const std::vector<CommandInfo>& verbs) {
  // Quote the completion words, because `compgen -W` would expand unquoted words. Bash inserts a
  // completion into the command line without further quoting.
  std::string text =
      "# bash completion of trackbed; written by `trackbed completion bash`.\n"
      "_trackbed_offer() {  # what, before each: those of the other words that begin with it\n"
      "  local begin=\"$1\" before=\"$2\" word quoted\n"
      "  COMPREPLY=()\n"
      "  shift 2\n"
      "  for word in \"$@\"; do\n"
      "    printf -v quoted %q \"$word\"\n"
      "    if [[ $word == \"$begin\"* || $quoted == \"$begin\"* ]]; then\n"
      "      COMPREPLY+=(\"$before$quoted\")\n"
      "    fi\n"
      "  done\n"
      "}\n"
      "_trackbed_values() {\n"
      "  _trackbed_offer \"$cur\" \"\" \"$@\"\n"
      "}\n"
      "_trackbed_list() {  # after the last comma\n"
      "  local done=\"\"\n"
      "  [[ $cur == *,* ]] && done=\"${cur%,*},\"\n"
      "  _trackbed_offer \"${cur##*,}\" \"$done\" \"$@\"\n"
      "}\n"
      "_trackbed() {\n"
      "  local cur=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
      "  local verb=\"\"\n"
      "  COMPREPLY=()\n"
      "  [[ $COMP_CWORD -gt 1 ]] && verb=\"${COMP_WORDS[1]}\"\n"
      "  if [[ $COMP_CWORD -gt 2 ]]; then\n"
      "    case \"$verb ${COMP_WORDS[2]}\" in\n";
  for (const CommandInfo& verb : verbs) {
    if (verb.name.find(' ') != std::string::npos) {
      text += fmt::format("      {0}) verb={0} ;;\n", QuotedText(verb.name));
    }
  }
  text +=
      "    esac\n"
      "  fi\n"
      "  case \"$verb\" in\n";
  const auto add_case = [&](const CommandInfo& verb) {
    text += fmt::format("    {})\n      case \"$before\" in\n", QuotedText(verb.name));
    Words names;
    for (const OptionInfo& option : OptionsOf(verb)) {
      const Words spellings = PartsOf(option.name, ',');
      names.insert(names.end(), spellings.begin(), spellings.end());
      if (!option.value.empty()) {
        const std::string values = AllQuoted(ValuesOf(option.value), QuotedForSh);
        text += fmt::format("        {}) {}return ;;\n", fmt::join(spellings, "|"),
                            values.empty()
                                ? ""
                                : fmt::format("_trackbed_{} {}; ",
                                              IsList(option.value) ? "list" : "values", values));
      }
    }
    text += fmt::format(
        "      esac\n"
        "      if [[ $cur == -* ]]; then _trackbed_values {}\n"
        "      else _trackbed_values {}\n"
        "      fi ;;\n",
        AllQuoted(names, QuotedForSh), AllQuoted(PositionalWords(verbs, verb), QuotedForSh));
  };
  for (const CommandInfo& verb : verbs) {
    add_case(verb);
  }
  text += fmt::format(
      "    '') _trackbed_values {} --help --version --color ;;\n"
      "  esac\n"
      "}}\n"
      "# Where nothing is found, names of files.\n"
      "complete -o bashdefault -o default -F _trackbed trackbed\n",
      AllQuoted(NamesOf(VerbsBelow(verbs, "")), QuotedForSh));
  return text;
}

namespace {

/// Generates zsh functions that offer names as completions. To prevent code injection, an argument
/// specification for _arguments contains only the name of a generated function, because zsh
/// evaluates such specifications as code.
class ZshOffers {
 public:
  /// Returns the name of a zsh function that offers the given names and all files.
  std::string OrFiles(const Words& names) { return Function(names, "  _files\n"); }

  /// Returns the name of a zsh function that completes the last word of a comma-separated list.
  std::string List(const Words& names) { return Function(names, "", "  compset -P '*,'\n"); }

  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string Function(const Words& names, const std::string& after,
                       const std::string& before = "") {
    const std::string body = fmt::format("{}  local -a names=({})\n  compadd -a names\n{}", before,
                                         AllQuoted(names, QuotedForSh), after);
    const auto [found, is_new] =
        names_.try_emplace(body, fmt::format("_trackbed_{}", names_.size()));
    if (is_new) {
      text_ += fmt::format("{}() {{\n{}}}\n", found->second, body);
    }
    return found->second;
  }

  // Names of the generated zsh functions, keyed by the code of the function.
  std::map<std::string, std::string> names_;
  std::string text_;
};

/// Quotes a text for a specification of the zsh functions _arguments or _describe.
std::string InZshSpecification(const std::string& text) {
  return Replaced(Replaced(Replaced(Replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":",
                  "\\:");
}

std::string ZshArguments(const std::vector<CommandInfo>& verbs, const CommandInfo& verb,
                         ZshOffers& offers) {
  std::string text = fmt::format("    {}) _arguments -s", QuotedText(verb.name));
  for (const OptionInfo& option : OptionsOf(verb)) {
    std::string value;
    if (!option.value.empty()) {
      const Words values = ValuesOf(option.value);
      value = fmt::format(":{}:{}", InZshSpecification(option.value),
                          values.empty()         ? "_files"
                          : IsList(option.value) ? offers.List(values)
                                                 : offers.OrFiles(values));
    }
    for (const std::string& name : PartsOf(option.name, ',')) {
      text += " \\\n      " +
              QuotedText(fmt::format("*{}[{}]{}", name, InZshSpecification(option.text), value));
    }
  }
  const Words others = PositionalWords(verbs, verb);
  return text +
         fmt::format(" \\\n      {} ;;\n",
                     QuotedText(others.empty() ? "*: :_files"
                                               : fmt::format("*: :{}", offers.OrFiles(others))));
}

}  // namespace

std::string ZshCompletion(const std::vector<CommandInfo>& verbs) {
  std::string text =
      "_trackbed() {\n"
      "  local -a verbs\n"
      "  verbs=(\n";
  for (const CommandInfo& verb : VerbsBelow(verbs, "")) {
    text += fmt::format("    {}\n", QuotedText(verb.name + ":" + InZshSpecification(verb.summary)));
  }
  text +=
      "  )\n"
      "  if (( CURRENT == 2 )); then\n"
      "    _describe -t verbs verb verbs\n"
      "    return\n"
      "  fi\n"
      "  local verb=\"${words[2]}\"\n"
      "  shift words; (( CURRENT-- ))\n"
      "  if (( CURRENT > 2 )); then\n"
      "    case \"$verb ${words[2]}\" in\n";
  for (const CommandInfo& verb : verbs) {
    if (verb.name.find(' ') != std::string::npos) {
      text += fmt::format("      {0}) verb={0}; shift words; (( CURRENT-- )) ;;\n",
                          QuotedText(verb.name));
    }
  }
  text +=
      "    esac\n"
      "  fi\n"
      "  case \"$verb\" in\n";
  ZshOffers offers;
  for (const CommandInfo& verb : verbs) {
    text += ZshArguments(verbs, verb, offers);
  }
  return "#compdef trackbed\n"
         "# zsh completion of trackbed; written by `trackbed completion zsh`.\n" +
         offers.text() + text +
         "  esac\n"
         "}\n"
         "_trackbed \"$@\"\n";
}

namespace {

/// Quotes a text that Trackbed itself defines, such as a help text, for fish.
std::string OwnTextOfFish(const std::string& text) {
  return QuotedForFish(text).value();
}

/// Formats completion words as the value of fish's option `complete --arguments`. Fish parses the
/// value of `--arguments` twice, so each word is quoted, and then the whole list of words is quoted
/// again.
std::string FishArguments(const Words& words) {
  return OwnTextOfFish(AllQuoted(words, QuotedForFish));
}

}  // namespace

std::string FishCompletion(const std::vector<CommandInfo>& verbs) {
  std::string text = "# fish completion of trackbed; written by `trackbed completion fish`.\n";
  for (const CommandInfo& verb : VerbsBelow(verbs, "")) {
    text += fmt::format("complete -c trackbed -n __fish_use_subcommand -f -a {} -d {}\n",
                        FishArguments({verb.name}), OwnTextOfFish(verb.summary));
  }
  for (const CommandInfo& verb : verbs) {
    std::string condition;
    for (const std::string& word : PartsOf(verb.name, ' ')) {
      condition += (condition.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + word);
    }
    const std::string start = fmt::format("complete -c trackbed -n {}", OwnTextOfFish(condition));
    for (const OptionInfo& option : OptionsOf(verb)) {
      text += start;
      for (const std::string& name : PartsOf(option.name, ',')) {
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      }
      if (!option.value.empty()) {
        const Words values = ValuesOf(option.value);
        text += values.empty() ? " -r" : fmt::format(" -x -a {}", FishArguments(values));
      }
      text += fmt::format(" -d {}\n", OwnTextOfFish(option.text));
    }
    const Words others = PositionalValues(verb);
    if (!others.empty()) {
      text += fmt::format("{} -a {}\n", start, FishArguments(others));
    }
    for (const CommandInfo& below : VerbsBelow(verbs, verb.name)) {
      text += fmt::format("{} -a {} -d {}\n", start, FishArguments({below.name}),
                          OwnTextOfFish(below.summary));
    }
  }
  return text;
}

}  // namespace trackbed::cli
