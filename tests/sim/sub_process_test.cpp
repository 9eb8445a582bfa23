#include "src/sim/sub_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <string>

namespace trackbed {
namespace {

// An orphaned sub-process would keep the program's locks, so that the next start could not use its
// folder.
TEST(InSubProcess, EndsWithTheProcessThatWaitsForIt) {
  std::array<int, 2> pipe{};
  ASSERT_EQ(::pipe(pipe.data()), 0);
  const pid_t program = ::fork();
  ASSERT_GE(program, 0);
  if (program == 0) {
    InSubProcess(
        [&] {
          const bool told = ::write(pipe[1], "x", 1) == 1;
          for (;;) {
            told ? ::pause() : 0;
          }
          return std::string();
        },
        1U << 30, 100);
    ::_exit(0);
  }
  ::close(pipe[1]);
  char told = 0;
  ASSERT_EQ(::read(pipe[0], &told, 1), 1);  // the sub-process is running
  ::kill(program, SIGKILL);
  ::waitpid(program, nullptr, 0);
  // The sub-process's end of the pipe is closed when it ends; otherwise this read blocks forever.
  EXPECT_EQ(::read(pipe[0], &told, 1), 0);
  ::close(pipe[0]);
}

}  // namespace
}  // namespace trackbed
