#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/recording.h"

namespace trackbed::render {

/// What a color in the picture stands for.
struct LegendEntry {
  Color color;
  std::string text;
  std::vector<Color> ramp{};  ///< in place of the color, from left to right
};

/// What is the same in every picture of a film.
struct Caption {
  std::string title;
  std::string note{};  ///< may be empty
  std::vector<LegendEntry> legend{};
};

/// Writes over the picture: the run's name (top left), under it the note and the wind if there are
/// any, the legend (top right) and the car's numbers (left, down to `bottom` [px]). The wind's
/// arrow points up when it blows along `azimuth`, where the camera looks [rad]. Returns where the
/// legend ends [px].
double DrawCaption(Image& image, Font& font, const Caption& caption, const Readings& readings,
                   double azimuth, double bottom);

}  // namespace trackbed::render
