#include <fmt/format.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/cli/manual_pages.h"
#include "src/cli/output_file.h"
#include "src/cli/shell_pages.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"

namespace trackbed::cli {

void AddCompletion(const Command& command) {
  using Make = std::function<std::string(const std::vector<CommandInfo>&)>;
  static const std::vector<std::pair<std::string, Make>> shells{
      {"bash", BashCompletion}, {"zsh", ZshCompletion}, {"fish", FishCompletion}};
  const auto shell = std::make_shared<std::string>();
  command.AddPositional("shell", *shell, "Shell that reads the script")
      .Required()
      .TypeName("bash|zsh|fish");
  command.AddExample("Complete verbs, options and names in this bash",
                     "source <(trackbed completion bash)");
  command.OnRun([shell, command] {
    std::vector<std::string> names;
    for (const auto& [name, make] : shells) {
      if (name == *shell) {
        Print("{}", Lines{make(command.VisibleVerbs())});
        return kOk;
      }
      names.push_back(name);
    }
    throw InputError(Problem{.message = "unknown shell " + UnknownName(*shell, names)});
  });
}

void AddManual(const Command& command) {
  command.Hide();  // --help does not show this verb, because only the build uses it
  const auto folder = std::make_shared<std::string>();
  command.AddPositional("folder", *folder, "Folder for the manual pages")
      .Required()
      .TypeName("DIR");
  command.OnRun([folder, command] {
    const std::vector<ManualPage> pages = ManualPages(command.VisibleVerbs());
    const std::filesystem::path path = *folder;
    for (const ManualPage& page : pages) {
      PrepareOutputFile("folder", path / page.file, {}, BeginsWith(".TH trackbed"));
    }
    for (const ManualPage& page : pages) {
      WriteFileAtomically(path / page.file, page.text);
    }
    return kOk;
  });
}

}  // namespace trackbed::cli
