#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

#include "tests/support/temp_folder.h"

namespace trackbed {

struct Outcome {
  int code = -1;
  std::string output;  // stdout and stderr
};

/// Runs a shell command in `folder`.
inline Outcome Shell(const TempFolder& folder, const std::string& script) {
  const std::string command = "cd '" + folder.path().string() + "' && { " + script + "; } 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"),
                                                   [](FILE*) { return 0; });
  Outcome outcome;
  std::array<char, 4096> block{};
  for (std::size_t got = 0; (got = fread(block.data(), 1, block.size(), pipe.get())) > 0;) {
    outcome.output.append(block.data(), got);
  }
  const int status = pclose(pipe.get());
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return outcome;
}

}  // namespace trackbed
