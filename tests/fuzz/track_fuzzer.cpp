#include "tests/fuzz/target.h"
#include "trackbed/core/error.h"
#include "trackbed/track/track_file.h"

/// Fuzzes a race track; writing it and reading it back must give the same track.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::filesystem::path file = fuzz::Write("track.csv", fuzz::Text(data, size));
  fuzz::Expect([&] {
    const TrackFile read = ReadTrackFile(file);
    const Track& track = read.track;
    const std::filesystem::path again = fuzz::Write("again.csv", TrackCsv(track.points()));
    TRACKBED_CHECK(ReadTrack(again, read.chosen_smoothing).points() == track.points(),
                   "the track is another one");
    static_cast<void>(track.Locate(track.left_edge().front()));
  });
  return 0;
}
