#pragma once

#include <pybind11/pybind11.h>

#include <atomic>

/// Threads that run functions of the package without the GIL, until the interpreter ends.
///
/// When the interpreter ends, Python ends every daemon thread that asks for the GIL, in the middle
/// of its C++ code, which would abort the process. Therefore BeginEnd() is called first: from then
/// on, the functions that daemon threads call do not return, and their runs are interrupted.
namespace trackbed::python {

/// Counts the functions of the package that run without the GIL. Python code can register plug-ins
/// only while no such function runs, because the registries are not thread-safe.
class RunningFunction {
 public:
  RunningFunction() { ++Count(); }
  RunningFunction(const RunningFunction&) = delete;
  RunningFunction& operator=(const RunningFunction&) = delete;
  ~RunningFunction() { --Count(); }

  /// Number of functions that run without the GIL. The caller must have the GIL.
  static std::atomic<int>& Count();
};

/// Releases the GIL. The function counts as running before the GIL is released, and until the GIL
/// is acquired again. Does not return in a thread that ends with the interpreter.
class WithoutGil {
 public:
  WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;
  ~WithoutGil();

 private:
  const RunningFunction running_;
  PyThreadState* const thread_;
};

/// Tells that the calling thread ends the interpreter.
void BeginEnd();

/// Whether another thread ends the interpreter, so that this thread should return soon.
bool EndsThisThread();

/// Forgets all other threads, which do not exist in a forked process. Requires the GIL.
void ForgetOtherThreads();

}  // namespace trackbed::python
