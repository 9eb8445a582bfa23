#include "tests/fuzz/target.h"
#include "trackbed/path/fit_path.h"
#include "trackbed/path_files/path_file.h"

/// Fuzzes a path in each of the formats, read and fitted.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::filesystem::path file = fuzz::Write("path.txt", fuzz::Text(data, size));
  for (const PathFormat format :
       {PathFormat::kCsv, PathFormat::kNavPath, PathFormat::kCommonRoad, PathFormat::kGeoJson,
        PathFormat::kGpx, PathFormat::kKml, PathFormat::kBag}) {
    fuzz::Expect([&] {
      PathMap map;
      map.format = format;
      const PathPoints points = ReadPathFile(file, map).points;
      for (const PathFit fit : {PathFit::kPolyline, PathFit::kSpline}) {
        static_cast<void>(FitPath(points, {.fit = fit}));
      }
    });
  }
  return 0;
}
