#pragma once

#include <filesystem>
#include <string>

namespace trackbed::bench {

/// The records that Google Benchmark writes (--benchmark_out, JSON), as tables for people.

/// Every ratio of a record with its quartiles and its limit, and every benchmark that failed with
/// its error. InputError with the file, and the benchmark, when it is no such record.
std::string RatioTable(const std::filesystem::path& record);

/// What changed from `before` to `after`: of a benchmark with a ratio the ratio, with its
/// quartiles, else the processor time. Ratios are called better or worse where their quartiles do
/// not overlap, times where they differ by more than a tenth; times only when both records are of
/// the same processor, cores and build type. Benchmarks of one record only are named.
std::string ChangeTable(const std::filesystem::path& before, const std::filesystem::path& after);

}  // namespace trackbed::bench
