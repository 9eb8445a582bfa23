#pragma once

#include <cstddef>

namespace trackbed::python {

/// Raises SystemExit in the Python code of all plug-ins that run on other threads. Returns the
/// number of these threads. Used when the interpreter ends: a thread must not be inside of a
/// plug-in then, because Python would end the thread in the middle of C++ code. Requires the GIL.
std::size_t InterruptPlugins();

/// Forgets the plug-ins that run on other threads, which do not exist in a forked process. Requires
/// the GIL.
void ForgetOtherPlugins();

}  // namespace trackbed::python
