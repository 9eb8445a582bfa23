#pragma once

#include <string>
#include <vector>

#include "src/cli/command.h"

/// Writes manual pages from the same descriptions of verbs and options as --help.
namespace trackbed::cli {

/// A manual page in section 1 (user commands) of the manual.
struct ManualPage {
  std::string file;  ///< file name such as "trackbed-run.1"
  std::string text;
};

/// Returns the manual pages: one page for the program and one page for each verb.
std::vector<ManualPage> ManualPages(const std::vector<CommandInfo>& verbs);

}  // namespace trackbed::cli
