#include "trackbed/scenario/run_track.h"

#include <optional>
#include <utility>

#include "src/scenario/local_origin.h"
#include "src/scenario/read_section.h"
#include "src/scenario/visit.h"
#include "trackbed/scenario/scenario.h"
#include "trackbed/track/track_file.h"

namespace trackbed {

Track ReadRunTrack(const std::filesystem::path& track_csv, const std::filesystem::path& scenario) {
  const auto mission = ReadSection<MissionSpec>(scenario, kMissionSection);
  Track track = ReadTrack(track_csv, mission.track ? mission.track->smoothing : std::nullopt);
  const Vec2 origin = ReadOrigin(scenario);
  return origin == Vec2::Zero() ? std::move(track) : Moved(track, -origin);
}

}  // namespace trackbed
