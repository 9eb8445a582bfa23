#include "tests/fuzz/target.h"
#include "trackbed/control/recording_file.h"
#include "trackbed/core/table.h"
#include "trackbed/core/text_table.h"

/// Fuzzes a CSV file: a log, and a recording over time and over distance.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace trackbed;
  const std::filesystem::path file = fuzz::Write("table.csv", fuzz::Text(data, size));
  fuzz::Expect([&] { static_cast<void>(ReadCsv(file).ToCsv()); });
  fuzz::Expect([&] { static_cast<void>(ReadTextCsv(file).ToCsv()); });
  for (const PlaybackAxis by : {PlaybackAxis::kTime, PlaybackAxis::kDistance}) {
    fuzz::Expect([&] { static_cast<void>(RecordingCsv(ReadRecording(file, by), by)); });
  }
  return 0;
}
