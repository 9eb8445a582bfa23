#pragma once

#include <memory>
#include <optional>
#include <string>

namespace trackbed {

class Track;

/// The section `mission.track` of a scenario: laps on a closed track.
struct TrackSpec {
  std::string file;  ///< File in a format of ReadTrack (track/track_file.h).
  int laps = 1;      ///< Number of timed laps, >= 1.
  /// Wavelength below which the center line is smoothed [m]; none: Track's default.
  std::optional<double> smoothing;

  // The track, which is not a key. Copies of the scenario share it.
  std::shared_ptr<const Track> data{};
};

}  // namespace trackbed
