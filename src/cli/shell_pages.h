#pragma once

#include <string>
#include <vector>

#include "src/cli/command.h"

/// Shell completion and manual pages, generated from the same tables as --help.
namespace trackbed::cli {

/// Completes verbs, options and values. The completed values are those that `trackbed list` prints,
/// or that the option's type name lists (auto|always|never). File names are completed in all other
/// places.
std::string BashCompletion(const std::vector<CommandInfo>& verbs);
std::string ZshCompletion(const std::vector<CommandInfo>& verbs);
std::string FishCompletion(const std::vector<CommandInfo>& verbs);

/// Manual page of section 1.
struct ManualPage {
  std::string file;  ///< file name such as "trackbed-run.1"
  std::string text;
};

/// Manual pages: one for the program and one for each verb.
std::vector<ManualPage> ManualPages(const std::vector<CommandInfo>& verbs);

}  // namespace trackbed::cli
