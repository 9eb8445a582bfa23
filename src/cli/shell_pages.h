#pragma once

#include <string>
#include <vector>

#include "src/cli/command.h"

/// Generates shell completions from the same descriptions of verbs and options as --help.
namespace trackbed::cli {

/// Returns a bash script that completes verbs, options and values. The script completes values that
/// `trackbed list` prints, and values that an option's type name lists, such as auto|always|never.
/// Where no verb, option or value is possible, the script completes file names.
std::string BashCompletion(const std::vector<CommandInfo>& verbs);
std::string ZshCompletion(const std::vector<CommandInfo>& verbs);
std::string FishCompletion(const std::vector<CommandInfo>& verbs);

/// Returns the options of a verb that are not positional arguments, including the options that
/// every verb has.
std::vector<OptionInfo> OptionsOf(const CommandInfo& verb);

}  // namespace trackbed::cli
