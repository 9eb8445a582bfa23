#pragma once

#include <filesystem>
#include <vector>

namespace trackbed::cli {

/// Prepares to write the file that an option names, before the work whose result it gets: creates
/// its folder and checks that it can be written (PrepareToWrite). An existing file will be
/// replaced, so throws InputError if the file is one of `inputs`, under this or another name, or a
/// file of a result (ResultThatLists). Inputs that do not exist, such as names of models, are
/// ignored.
void PrepareOutputFile(const char* option, const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& inputs);

}  // namespace trackbed::cli
