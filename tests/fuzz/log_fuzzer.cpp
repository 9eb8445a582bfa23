#include "tests/fuzz/target.h"
#include "trackbed/recording/import_log.h"
#include "trackbed/recording/log_listing.h"

/// Fuzzes recordings in each kind of file: the listing, and the import by the proposed map.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  for (const char* name : {"log.csv", "log.gpx", "log.geojson", "log.mcap"}) {
    const std::filesystem::path file = fuzz::Write(name, fuzz::Text(data, size));
    fuzz::Expect([&] {
      LogListing listing = ListLog(file);
      if (listing.map) {
        // An input for which a long drive is resampled takes long and finds nothing new.
        listing.map->to = 100.0;
        listing.map->resample.rate = 1.0;
        static_cast<void>(ImportLog(file, *listing.map));
      }
    });
  }
  return 0;
}
