#include "tests/fuzz/target.h"
#include "trackbed/sim/scene.h"

/// Fuzzes the MJCF file of a car, including MuJoCo's compiler, which runs in a child process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  static const std::filesystem::path part =
      fuzz::Write("part.xml", "<mujoco><size njmax='500'/></mujoco>");
  static const std::filesystem::path mesh =
      fuzz::Write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  const std::filesystem::path file = fuzz::Write("car.xml", fuzz::Text(data, size));
  return fuzz::Expect([&] {
    const Scene scene = ComposeScene(file, {.timestep = 0.001, .steering_rate = 0.5});
    for (const int line : {0, 1, 2, 100}) {
      static_cast<void>(LineInCarFile(scene, line));
    }
  });
}
