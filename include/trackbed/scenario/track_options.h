#pragma once

#include <memory>
#include <optional>
#include <string>

namespace trackbed {

class Track;

/// The section `mission.track` of a scenario: laps on a closed track.
struct TrackSpec {
  std::string file;                 ///< as ReadTrack (track/track_file.h)
  int laps = 1;                     ///< timed laps, >= 1
  std::optional<double> smoothing;  ///< of the center line: a wavelength [m]; none: Track's default

  // Not a key: the track itself, shared by all scenarios copied from one.
  std::shared_ptr<const Track> data{};
};

}  // namespace trackbed
