#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/overlay.h"
#include "render/recording.h"

namespace trackbed::render {

/// What is the same in every picture of a film.
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

/// Writes over the picture: the run's name (top left), under it the note and the wind if there are
/// any, of a note what is no wider than 0.7 of the picture, the legend (top right) and the readings
/// (left, down to `bottom` [px]). The wind's arrow points up when it blows along `azimuth`, where
/// the camera looks [rad]. Returns the rows between the legend and the readings.
Rows DrawCaption(Image& image, Font& font, const Caption& caption, const Readings& readings,
                 double azimuth, double bottom);

/// The caption of the recording, above what other panels have taken of the picture's bottom.
OverlayEntry CaptionOverlay();

}  // namespace trackbed::render
