#pragma once

#include <string>
#include <vector>

#include "src/cli/command.h"

/// Generates shell completions and manual pages from the same descriptions of verbs and options as
/// --help.
namespace trackbed::cli {

/// Returns a bash script that completes verbs, options and values. The script completes values that
/// `trackbed list` prints, and values that an option's type name lists, such as auto|always|never.
/// Where no verb, option or value is possible, the script completes file names.
std::string BashCompletion(const std::vector<CommandInfo>& verbs);
std::string ZshCompletion(const std::vector<CommandInfo>& verbs);
std::string FishCompletion(const std::vector<CommandInfo>& verbs);

/// A manual page in section 1 (user commands) of the manual.
struct ManualPage {
  std::string file;  ///< file name such as "trackbed-run.1"
  std::string text;
};

/// Returns the manual pages: one page for the program and one page for each verb.
std::vector<ManualPage> ManualPages(const std::vector<CommandInfo>& verbs);

}  // namespace trackbed::cli
