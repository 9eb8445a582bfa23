#include "tests/fuzz/target.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// Fuzzes a scenario file; the lines before a NUL byte are values of --set.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  std::string yaml = fuzz::Text(data, size);
  std::vector<Override> overrides;
  if (const std::size_t end = yaml.find('\0'); end != std::string::npos) {
    for (std::size_t begin = 0; begin < end;) {
      const std::size_t line = std::min(yaml.find('\n', begin), end);
      overrides.push_back(yaml.substr(begin, line - begin));
      begin = line + 1;
    }
    yaml.erase(0, end + 1);
  }
  return fuzz::Expect([&] {
    const Scenario scenario =
        ParseScenario(yaml, "fuzz.yaml", fuzz::Folder(), overrides, PossibleMetrics);
    static_cast<void>(ResolvedYaml(scenario));
  });
}
