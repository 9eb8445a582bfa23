#pragma once

#include <filesystem>
#include <string>

namespace trackbed::bench {

/// Prints records of Google Benchmark (--benchmark_out, JSON) as tables.

/// Lists every ratio of a record with its quartiles and limit, and every failed benchmark with its
/// error. Throws InputError with the file and the benchmark if the record is invalid.
std::string RatioTable(const std::filesystem::path& record);

/// Lists the changes from `before` to `after`: of a benchmark with a ratio the ratio and its
/// quartiles, otherwise the processor time. Ratios count as better or worse if their quartiles do
/// not overlap, times if they differ by more than a tenth. Times are compared only if both records
/// have the same processor, number of cores and build type. Benchmarks of only one record are
/// named.
std::string ChangeTable(const std::filesystem::path& before, const std::filesystem::path& after);

}  // namespace trackbed::bench
