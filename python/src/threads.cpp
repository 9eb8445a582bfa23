#include "python/src/threads.h"

#include <cxxabi.h>
#include <unistd.h>

#include <thread>

#include "python/src/plugin_threads.h"
#include "python/src/plugins.h"

namespace trackbed::python {
namespace {

/// The thread that ends the interpreter; valid if `ending` is set.
std::thread::id ending_thread;
std::atomic<bool> ending{false};

/// Waits until the process ends.
[[noreturn]] void WaitForTheEnd() {
  while (true) {
    pause();
  }
}

}  // namespace

std::atomic<int>& RunningFunction::Count() {
  static std::atomic<int> count{0};
  return count;
}

WithoutGil::WithoutGil() : thread_(PyEval_SaveThread()) {
  // A plug-in returns to the run that called it, which then ends.
  if (EndsThisThread() && !InsidePlugin()) {
    --RunningFunction::Count();
    WaitForTheEnd();
  }
}

WithoutGil::~WithoutGil() {
  try {
    PyEval_RestoreThread(thread_);
  } catch (const abi::__forced_unwind&) {  // The interpreter has ended meanwhile.
    WaitForTheEnd();
  }
}

void BeginEnd() {
  ending_thread = std::this_thread::get_id();
  ending = true;
}

bool EndsThisThread() {
  return ending && std::this_thread::get_id() != ending_thread;
}

void ForgetOtherThreads() {
  if (!InsidePlugin()) {
    RunningFunction::Count() = 0;
  }
  ForgetOtherPlugins();
}

}  // namespace trackbed::python
