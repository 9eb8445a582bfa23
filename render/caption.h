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

/// Writes over the picture: the run's name (top left), the legend (top right) and the car's numbers
/// (bottom left). Sizes follow the picture's height but stay readable down to 640x360; in smaller
/// pictures everything shrinks to fit the width.
void DrawCaption(Image& image, Font& font, const std::string& title,
                 const std::vector<LegendEntry>& legend, const Readings& readings);

}  // namespace trackbed::render
