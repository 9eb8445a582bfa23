#include "render/overlays.h"

#include <algorithm>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {

const std::vector<Overlay>& OverlayTable() {
  static const std::vector<Overlay> table{
      {"plan", "the planned path, and each new one", &Overlays::plan},
      {"trail", "where the cars have been", &Overlays::trail},
      {"error", "the car's trail in the color of its distance from the path", &Overlays::error},
      {"ghosts", "the other plants as translucent cars", &Overlays::ghosts},
      {"wind", "arrows of the wind over the ground, and the outline of where a gust blows",
       &Overlays::wind},
      {"forces", "the tyres' forces inside what friction allows them", &Overlays::forces},
      {"strip", "planned curvature and steering over time", &Overlays::strip},
      {"caption", "name, legend and the car's numbers", &Overlays::caption},
  };
  return table;
}

Overlays OverlaysOf(const std::vector<std::string>& names) {
  const std::vector<Overlay>& table = OverlayTable();
  Overlays overlays;
  for (const std::string& name : names) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [&](const Overlay& overlay) { return overlay.name == name; });
    if (found == table.end()) {
      std::vector<std::string> known;
      for (const Overlay& overlay : table) {
        known.emplace_back(overlay.name);
      }
      throw InputError(
          Problem{.key = "overlays", .message = "unknown overlay " + UnknownName(name, known)});
    }
    overlays.*(found->shown) = true;
  }
  return overlays;
}

}  // namespace trackbed::render
