#include <vector>

#include "src/path_files/formats.h"
#include "tests/fuzz/target.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_file.h"

namespace trackbed {
namespace {

/// Returns the ids of the first and the last relation of an OSM file, between which a route of a
/// Lanelet2 map is tried; empty without relations.
std::vector<std::string> EndsOfRoute(const std::string& text) {
  const auto id_after = [&](std::size_t relation) {
    const std::size_t begin = text.find_first_of("'\"", relation);
    const std::size_t end =
        begin == std::string::npos ? begin : text.find_first_of("'\"", begin + 1);
    return end == std::string::npos ? std::string() : text.substr(begin + 1, end - begin - 1);
  };
  const std::size_t first = text.find("<relation");
  if (first == std::string::npos) {
    return {};
  }
  return {id_after(first), id_after(text.rfind("<relation"))};
}

}  // namespace
}  // namespace trackbed

/// Reads the input as a path file of each format, and fits a path to the points.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::string text = fuzz::Text(data, size);
  const std::filesystem::path file = fuzz::Write("path.txt", text);
  for (const PathFormatEntry& entry : PathFormats()) {
    fuzz::Expect([&] {
      PathMap map;
      map.format = entry.format;
      if (entry.format == PathFormat::kLanelet2) {
        map.lanelets = EndsOfRoute(text);
      }
      const PathPoints points = ReadPathFile(file, map).points;
      for (const PathFit fit : {PathFit::kPolyline, PathFit::kSpline}) {
        static_cast<void>(FitPath(points, {.fit = fit}));
      }
    });
  }
  return 0;
}
