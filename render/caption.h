#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// Caption texts that stay the same in every picture of a film.
struct Caption {
  std::string title;
  std::string note{};  ///< may be empty
  std::vector<LegendEntry> legend{};
};

/// Rows of a picture [px], from `top` to `bottom`.
struct Rows {
  double top = 0;
  double bottom = 0;
};

/// Draws the texts of a picture: run name, note and wind at the top left, the legend at the top
/// right, and the readings at the left, above `bottom` [px]. A note longer than 0.7 of the
/// picture's width is shortened. The wind's arrow points up if the wind blows along `azimuth`, the
/// camera's direction [rad]. Returns the rows of the picture between the legend and the readings.
Rows DrawCaption(Image& image, Font& font, const Caption& caption, const Readings& readings,
                 double azimuth, double bottom);

/// Returns the overlay that draws the caption. The readings are placed above the panels that were
/// already drawn at the bottom.
OverlayEntry CaptionOverlay();

}  // namespace trackbed::render
