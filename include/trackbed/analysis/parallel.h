#pragma once

#include <cstddef>
#include <functional>

namespace trackbed {

/// Calls `work` with every index below `count`, in any order, on the given number of threads
/// (including the calling thread). Stops when a call returns false or throws; the exception is
/// rethrown. Calls that have begun are finished.
void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work);

}  // namespace trackbed
