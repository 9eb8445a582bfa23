#pragma once

#include <cstddef>
#include <functional>

namespace trackbed {

/// Calls `work` with every index below `count`, in any order, on the given number of threads
/// (including the calling thread). Starts no further calls after a call has returned false or
/// thrown an exception, which is rethrown. Calls that are already running are finished.
void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work);

}  // namespace trackbed
