#include "tests/fuzz/target.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/tyre_file.h"

/// Fuzzes a tyre property file. The reader must give finite forces for every file that it accepts.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  fuzz::Expect([&] {
    const TyreFile file = ParseTyreFile(fuzz::Text(data, size), "tyre.tir");
    const double load = file.tyre.f_z0;
    TRACKBED_CHECK(CorneringStiffness(file.tyre, load) > 0.0, "the stiffness is not above 0");
    TRACKBED_CHECK(!TyreNumbers(file, file).empty(), "the tyre has no numbers");
    static_cast<void>(EvaluateTyreForce(file.tyre, load, 0.5, {.ratio = 0.1, .angle = 0.1}));
  });
  return 0;
}
