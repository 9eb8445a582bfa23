#include "src/cli/output_file.h"

#include <fmt/format.h>

#include <system_error>

#include "trackbed/analysis/foreign_files.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Refuse(const char* option, const fs::path& file, const std::string& reason) {
  throw InputError(Problem{.file = option,
                           .message = fmt::format("{} {}, and would be replaced; name another file",
                                                  file.string(), reason)});
}

}  // namespace

void PrepareOutputFile(const char* option, const fs::path& file,
                       const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code missing;
    if (fs::is_regular_file(file, missing) && fs::equivalent(file, input, missing)) {
      Refuse(option, file, "is an input of this command");
    }
  }
  if (const std::string result = ResultThatLists(file); !result.empty()) {
    Refuse(option, file, fmt::format("is a file of the {} in its folder", result));
  }
  PrepareToWrite(file);
}

}  // namespace trackbed::cli
