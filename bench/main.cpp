#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <Eigen/Core>
#include <exception>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "bench/record.h"
#include "render/gl_choice.h"
#include "trackbed/core/version.h"
#include "trackbed/optimize/search.h"
#include "trackbed/render/film.h"
#include "trackbed/sim/car_model.h"

namespace {

#ifdef __clang__
constexpr const char* kCompiler = "Clang " __clang_version__;
#else
constexpr const char* kCompiler = "GCC " __VERSION__;
#endif

std::string CpuModel() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) {
      return line.substr(line.find(':') + 2);
    }
  }
  return "unknown";
}

std::string OpenGlVersion() {
  try {
    const auto context = trackbed::render::MakeGlContext("auto");
    return fmt::format("{}: {}", NameOf(context->library()), context->Version());
  } catch (const std::exception& error) {
    return error.what();
  }
}

/// `trackbed_bench table RECORD` and `trackbed_bench against BEFORE AFTER`.
int PrintRecords(const std::vector<std::string>& words) {
  try {
    if (words.size() == 2 && words[0] == "table") {
      fmt::print("{}", trackbed::bench::RatioTable(words[1]));
      return 0;
    }
    if (words.size() == 3 && words[0] == "against") {
      fmt::print("{}", trackbed::bench::ChangeTable(words[1], words[2]));
      return 0;
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  fmt::print(stderr, "usage: trackbed_bench table RECORD | against BEFORE AFTER | OPTION...\n");
  return 2;
}

}  // namespace

/// Runs Google Benchmark, which writes the machine's data to records, or prints tables of such
/// records.
int main(int argc, char** argv) {
  if (argc > 1 && argv[1][0] != '-') {
    return PrintRecords({argv + 1, argv + argc});
  }
  benchmark::AddCustomContext("cpu", CpuModel());
  benchmark::AddCustomContext("cores", std::to_string(std::thread::hardware_concurrency()));
  benchmark::AddCustomContext("compiler", kCompiler);
  benchmark::AddCustomContext("build_type", TRACKBED_BUILD_TYPE);
  benchmark::AddCustomContext("trackbed", trackbed::Version());
  benchmark::AddCustomContext("physics", trackbed::PhysicsVersion());
  benchmark::AddCustomContext("opengl", OpenGlVersion());
  benchmark::AddCustomContext("video", trackbed::VideoEncoder());
  benchmark::AddCustomContext("eigen", fmt::format("{}.{}.{}", EIGEN_WORLD_VERSION,
                                                   EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION));
  benchmark::AddCustomContext("optimizer", trackbed::OptimizerVersion());
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) {
    return 1;
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
