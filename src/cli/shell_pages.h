#pragma once

#include <string>
#include <vector>

#include "src/cli/command.h"

/// What shells and `man` read about the program, made from the tables that --help is made from.
namespace trackbed::cli {

/// Completion of verbs, options and of those values that `trackbed list` names or that the option's
/// type name lists (auto|always|never); of file names elsewhere.
std::string BashCompletion(const std::vector<CommandInfo>& verbs);
std::string ZshCompletion(const std::vector<CommandInfo>& verbs);
std::string FishCompletion(const std::vector<CommandInfo>& verbs);

/// A page of `man`, section 1.
struct ManualPage {
  std::string file;  ///< "trackbed-run.1"
  std::string text;
};

/// One of the program and one of each verb.
std::vector<ManualPage> ManualPages(const std::vector<CommandInfo>& verbs);

}  // namespace trackbed::cli
