#include "tests/fuzz/target.h"
#include "trackbed/sim/scene.h"

/// Fuzzes a file that a model refers to; the first byte selects its kind.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  if (size == 0) {
    return 0;
  }
  struct Asset {
    const char* element;
    const char* file;
  };
  static constexpr Asset kAssets[] = {{"mesh", "a.stl"},
                                      {"mesh", "a.obj"},
                                      {"texture", "a.png"},
                                      {"hfield", "a.hfield"},
                                      {"hfield", "a.png"}};
  const Asset& asset = kAssets[data[0] % std::size(kAssets)];
  fuzz::Write(asset.file, fuzz::Text(data + 1, size - 1));
  const std::filesystem::path file =
      fuzz::Write("car.xml", std::string("<mujoco><asset><") + asset.element + " file='" +
                                 asset.file + "'/></asset></mujoco>");
  return fuzz::Expect([&] { static_cast<void>(ComposeScene(file, {})); });
}
