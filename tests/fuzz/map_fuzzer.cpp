#include "tests/fuzz/target.h"
#include "trackbed/scenario/map_file.h"
#include "trackbed/scenario/moving_ai.h"
#include "trackbed/scenario/moving_ai_instances.h"

/// Fuzzes a grid map: the image of a ROS map, its YAML file, a Moving AI map and its instances.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::string text = fuzz::Text(data, size);
  const std::filesystem::path file = fuzz::Write("map.map", text);
  fuzz::Expect([&] {
    const GridMap map = ReadMovingAiMap(file, 1.0);
    static_cast<void>(MapPgm(map).size() + MapYaml(map).size());
    static_cast<void>(ReadMap({.file = "map.map", .cell = 1.0}, fuzz::Folder()));
  });
  fuzz::Expect([&] { static_cast<void>(ReadMovingAiInstances(file)); });
  fuzz::Expect([&] { static_cast<void>(ReadRosMap(file)); });
  const std::filesystem::path yaml =
      fuzz::Write("map.yaml",
                  "image: map.map\nmode: scale\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                  "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  fuzz::Expect([&] { static_cast<void>(MapPgm(ReadRosMap(yaml)).size()); });
  return 0;
}
