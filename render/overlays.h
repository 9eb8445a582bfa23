#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed::render {

/// What is drawn over the recorded world.
struct Overlays {
  bool plan = false;
  bool trail = false;
  bool error = false;
  bool ghosts = false;
  bool wind = false;
  bool forces = false;
  bool strip = false;
  bool caption = false;
};

struct Overlay {
  std::string_view name;
  std::string_view summary;
  bool Overlays::*shown;
};

/// The only list of overlays.
const std::vector<Overlay>& OverlayTable();

/// The overlays of these names; InputError with the nearest name where there is no such overlay.
Overlays OverlaysOf(const std::vector<std::string>& names);

}  // namespace trackbed::render
