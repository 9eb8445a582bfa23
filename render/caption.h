#pragma once

#include <string>
#include <vector>

#include "render/canvas.h"
#include "render/recording.h"

namespace trackbed::render {

/// What a colour in the picture stands for.
struct LegendEntry {
  Color color;
  std::string text;
};

/// Writes over the picture: the run's name (top left), under it the note and the wind if there are
/// any, the legend (top right) and the car's numbers (bottom left). The wind's arrow points up when
/// it blows along `azimuth`, where the camera looks [rad]. Sizes follow the picture's height but
/// stay readable down to 640x360; in smaller pictures everything shrinks to fit the width.
void DrawCaption(Image& image, Font& font, const std::string& title, const std::string& note,
                 const std::vector<LegendEntry>& legend, const Readings& readings, double azimuth);

}  // namespace trackbed::render
