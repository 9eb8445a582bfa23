#pragma once

#include <array>
#include <vector>

#include "render/overlay.h"

/// A trail colored by the cross-track error.
namespace trackbed::render {

/// Colors of the trail, from zero error to Scales::error.
inline constexpr std::array<Color, 5> kErrorColors{{{0.27F, 0.00F, 0.33F},
                                                    {0.23F, 0.32F, 0.55F},
                                                    {0.13F, 0.57F, 0.55F},
                                                    {0.37F, 0.79F, 0.38F},
                                                    {0.99F, 0.91F, 0.14F}}};

/// The color of a fraction of the scale, in [0, 1].
Color ErrorColor(double fraction);

/// Whether the car follows a path and its log has the cross-track error.
bool HasErrorScale(const Recording& recording);

/// The car's cross-track error as fractions of Scales::error, one per recorded state. The fractions
/// are quantized in coarse steps, so that long stretches have one color. Hysteresis ignores small
/// oscillations between two steps. The recording must satisfy HasErrorScale.
std::vector<double> ErrorFractions(const Recording& recording);

/// The car's trail in the colors of its cross-track error; draws nothing without a path.
OverlayEntry ErrorOverlay();

}  // namespace trackbed::render
