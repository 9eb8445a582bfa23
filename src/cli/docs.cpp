#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <sstream>

#include "src/cli/verbs.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/scenario/keys.h"

namespace trackbed::cli {
namespace {

/// A generated part (block) of a documentation page, between two marker lines.
struct Block {
  std::string name;
  std::string markdown;
  bool placed = false;
};

const std::string kBegin = "<!-- begin: ";
const std::string kClose = " -->";
const std::string kEnd = "<!-- end -->";

/// Escapes text for a table cell of GitHub Markdown.
std::string Cell(const std::string& text) {
  std::string cell;
  for (const char c : text) {
    cell += c == '|' || c == '<' || c == '*' ? "\\" : "";
    cell += c;
  }
  return cell;
}

/// Formats text as code for a Markdown table cell, in which only the character | must be escaped.
std::string Code(const std::string& text) {
  std::string cell;
  for (const char c : text) {
    cell += c == '|' ? "\\|" : std::string(1, c);
  }
  return cell.empty() ? "" : "`" + cell + "`";
}

std::string Sentence(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text + ".";
}

std::string VerbTable(const std::vector<CommandInfo>& verbs) {
  std::string table = "| verb | does |\n|---|---|\n";
  for (const CommandInfo& verb : verbs) {
    table += fmt::format("| {} | {} |\n", Code(verb.name), Cell(verb.summary));
  }
  return table;
}

/// Returns a Markdown table of the options of a verb. The table omits the option --help, which the
/// page describes once for all verbs.
std::string OptionTable(const CommandInfo& verb) {
  std::string table = "| argument | means |\n|---|---|\n";
  for (const OptionInfo& option : verb.options) {
    table += fmt::format("| {}{} | {}{}{} |\n",
                         Code(option.name + (option.value.empty() ? "" : " " + option.value)),
                         option.required ? ", required" : "", Cell(option.text),
                         option.fallback.empty() ? "" : "; default ", Code(option.fallback));
  }
  return table;
}

std::string KeyTables(const std::vector<KeySection>& sections) {
  std::string text;
  for (const KeySection& section : sections) {
    text += text.empty() ? "" : "\n";
    if (!section.key.empty()) {
      text += fmt::format("### {}{}\n\n", Code(section.key),
                          section.method.empty() ? "" : ", method " + Code(section.method));
    }
    text += Sentence(section.text) + "\n";
    if (section.keys.empty()) {
      continue;
    }
    text += "\n| key | is | unit | default | allowed | means |\n|---|---|---|---|---|---|\n";
    for (const KeyInfo& key : section.keys) {
      text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", Code(key.name), key.type, key.unit,
                          key.required ? "required" : Code(key.fallback), Cell(key.allowed),
                          Cell(key.text));
    }
  }
  return text;
}

/// Formats names as Markdown code, separated by commas.
std::string NameList(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "" : ", ") + Code(name);
  }
  return list;
}

/// Returns two Markdown tables: a table of the files of each kind of result, and a table of the
/// results that each verb writes.
std::string WrittenNamesTables() {
  std::string tables = "| result | its files |\n|---|---|\n";
  for (const ResultNames& result : AllResultNames()) {
    tables += fmt::format("| {} | {} |\n", result.result, NameList(result.names));
  }
  tables += "\n| verb | results | other names | options that name a file |\n|---|---|---|---|\n";
  for (const VerbNames& verb : AllVerbNames()) {
    tables += fmt::format("| {} | {} | {} | {} |\n", Code(verb.verb),
                          fmt::format("{}", fmt::join(verb.results, ", ")), NameList(verb.others),
                          NameList(verb.explicit_files));
  }
  return tables;
}

std::vector<Block> Blocks(const std::vector<CommandInfo>& verbs) {
  std::vector<Block> blocks{{"verbs", VerbTable(verbs)}};
  for (const CommandInfo& verb : verbs) {
    blocks.push_back({"options of " + verb.name, OptionTable(verb)});
  }
  blocks.push_back({"written names", WrittenNamesTables()});
  blocks.push_back({"scenario keys", KeyTables(ScenarioKeys())});
  blocks.push_back({"study keys", KeyTables(StudyKeys())});
  blocks.push_back({"identification keys", KeyTables(IdentificationKeys())});
  blocks.push_back({"map keys", KeyTables(LogMapKeys())});
  return blocks;
}

/// Returns the documentation page with the generated text of each block inserted between the
/// block's marker lines.
std::string Filled(const std::string& file, const std::string& page, std::vector<Block> blocks) {
  std::vector<std::string> names;
  for (const Block& block : blocks) {
    names.push_back(block.name);
  }
  std::istringstream lines(page);
  std::string filled;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    filled += line + "\n";
    if (!line.starts_with(kBegin) || !line.ends_with(kClose)) {
      continue;
    }
    const int begin = number;
    const std::string name =
        line.substr(kBegin.size(), line.size() - kBegin.size() - kClose.size());
    const auto block =
        std::find_if(blocks.begin(), blocks.end(), [&](const Block& b) { return b.name == name; });
    if (block == blocks.end()) {
      throw InputError(Problem{file, begin, 1, "", "unknown " + UnknownName(name, names)});
    }
    block->placed = true;
    filled += "\n" + block->markdown + "\n" + kEnd + "\n";
    while (line != kEnd) {
      ++number;
      if (!std::getline(lines, line)) {
        throw InputError(Problem{file, begin, 1, "", fmt::format("no line '{}' follows", kEnd)});
      }
    }
  }
  for (const Block& block : blocks) {
    if (!block.placed) {
      throw InputError(Problem{
          .file = file,
          .message =
              fmt::format("no markers for '{0}'; add the lines '{1}{0}{2}' and '{3}' to the page",
                          block.name, kBegin, kClose, kEnd)});
    }
  }
  return filled;
}

}  // namespace

void AddDocs(const Command& command) {
  command.Hide();  // --help does not show this verb, because only developers of Trackbed use it
  const auto page = std::make_shared<std::string>();
  command.AddPositional("page", *page, "Markdown file to update").Required().TypeName("FILE");
  command.OnRun([page, command] {
    RemoveAbandonedTemporaries(std::filesystem::path(*page).parent_path());
    WriteFileAtomically(*page, Filled(*page, ReadFile(*page), Blocks(command.VisibleVerbs())));
    return kOk;
  });
}

}  // namespace trackbed::cli
