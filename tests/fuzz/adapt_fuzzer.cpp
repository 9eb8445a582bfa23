#include "tests/fuzz/target.h"
#include "trackbed/sim/adapt.h"

/// Fuzzes the MJCF or URDF file that AdaptModel reads. MuJoCo's compiler runs in a child process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::filesystem::path file = fuzz::Write("robot.xml", fuzz::Text(data, size));
  return fuzz::Expect([&] { static_cast<void>(AdaptModel(file, {})); });
}
