#pragma once

#include <cstddef>
#include <functional>

namespace trackbed {

/// Calls `work` with every index below `count`, in any order, on the given number of threads
/// (including the calling thread). After a call has returned false or thrown an exception, no
/// further calls are started; the exception is rethrown. If `work` stops early, calls that are
/// already running are finished first.
void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work);

}  // namespace trackbed
