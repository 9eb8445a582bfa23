#pragma once

#include <array>
#include <vector>

#include "render/overlay.h"

/// Computes the colors of a trail of the car by its cross-track error.
namespace trackbed::render {

/// Colors of the trail, for cross-track errors from zero to Scales::error.
inline constexpr std::array<Color, 5> kErrorColors{{{0.27F, 0.00F, 0.33F},
                                                    {0.23F, 0.32F, 0.55F},
                                                    {0.13F, 0.57F, 0.55F},
                                                    {0.37F, 0.79F, 0.38F},
                                                    {0.99F, 0.91F, 0.14F}}};

/// Returns the trail's color for a cross-track error of `fraction` times Scales::error; `fraction`
/// is in [0, 1].
Color ErrorColor(double fraction);

/// Whether the recorded car follows a path and the car's log contains the cross-track error.
bool HasErrorScale(const Recording& recording);

/// Returns the car's cross-track error at each recorded state, as a fraction of Scales::error. The
/// returned fractions are quantized in coarse steps, so that long stretches have one color. The
/// quantization of the error fractions has hysteresis, so small oscillations between two steps do
/// not change the color. HasErrorScale must be true for the recording.
std::vector<double> ErrorFractions(const Recording& recording);

/// Returns the overlay that draws the car's trail in the colors of its cross-track error. Without a
/// planned path, the overlay of the error ribbon draws nothing.
OverlayEntry ErrorOverlay();

}  // namespace trackbed::render
