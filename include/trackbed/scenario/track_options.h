#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

class Track;

/// The section `mission.track` of a scenario: laps on a closed track.
struct TrackSpec {
  std::string file;  ///< Track file in a format that ReadTrack can read (track/track_file.h).
  int laps = 1;      ///< Number of laps that are timed, >= 1.
  /// Wavelength of the smoothing of the center line [m]: bends of a shorter wavelength are smoothed
  /// out; nullopt: the default of Track.
  std::optional<double> smoothing;

  /// Width of the track [m], half on either side of the center line, for files without widths.
  std::optional<double> width;

  // The track, which copies of the scenario share. The track is not a key of the scenario file.
  std::shared_ptr<const Track> data{};
  // Notes of ReadTrackFile.
  std::vector<std::string> notes{};
};

}  // namespace trackbed
