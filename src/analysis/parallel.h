#pragma once

#include <cstddef>
#include <functional>

namespace trackbed {

/// Calls `work` with every index below `count`, on as many threads as asked, until one call says
/// to stop or throws; the exception is thrown on.
void ForEachIndex(std::size_t count, int threads, const std::function<bool(std::size_t)>& work);

}  // namespace trackbed
