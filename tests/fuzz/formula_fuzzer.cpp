#include "tests/fuzz/target.h"
#include "trackbed/requirement/robustness.h"

/// Fuzzes a formula, evaluated on a short log.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  static const Table log = [] {
    Table table({"t_s", "x_m", "speed_mps"});
    for (int i = 0; i < 20; ++i) {
      table.AddRow({0.1 * i, i % 7 - 3.0, 0.5 * (i % 3)});
    }
    return table;
  }();
  fuzz::Expect([&] {
    const Formula formula = Formula::Parse(fuzz::Text(data, size), log.columns());
    static_cast<void>(formula.horizon_s());
    static_cast<void>(Evaluate(formula, log));
  });
  return 0;
}
