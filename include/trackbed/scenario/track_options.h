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
  /// Wavelength below which the center line is smoothed [m]; nullopt: the default of Track.
  std::optional<double> smoothing;

  // The track, shared by copies of the scenario. The member is not a key of the file.
  std::shared_ptr<const Track> data{};
};

}  // namespace trackbed
