#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// Texts of the caption that are the same in every frame of a film.
struct Caption {
  std::string title;
  std::string note{};  ///< may be empty
  std::vector<LegendEntry> legend{};
};

/// Range of rows of a frame [px], from `top` to `bottom`.
struct Rows {
  double top = 0;
  double bottom = 0;
};

/// Draws the texts of a frame: run name, note and wind at the top left, the legend at the top
/// right, and the readings at the left, above `bottom` [px]. The note is shortened if it is wider
/// than 0.7 of the frame's width. The wind arrow points up if the wind blows along `azimuth`, the
/// camera's direction [rad]. Returns the rows of the frame between the legend and the readings.
Rows DrawCaption(Image& image, Font& font, const Caption& caption, const Readings& readings,
                 double azimuth, double bottom);

/// Returns the overlay that draws the caption. The readings of the caption are placed above the
/// panels that were already drawn at the bottom.
OverlayEntry CaptionOverlay();

}  // namespace trackbed::render
