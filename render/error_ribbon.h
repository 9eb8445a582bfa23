#pragma once

#include <array>
#include <vector>

#include "render/overlay.h"

/// A trail colored by the cross-track error.
namespace trackbed::render {

/// Colors from on the path to Scales::error.
inline constexpr std::array<Color, 5> kErrorColors{{{0.10F, 0.62F, 0.36F},
                                                    {0.58F, 0.78F, 0.22F},
                                                    {0.99F, 0.80F, 0.16F},
                                                    {0.96F, 0.46F, 0.12F},
                                                    {0.80F, 0.08F, 0.16F}}};

/// The color of a fraction of the scale, in [0, 1].
Color ErrorColor(double fraction);

/// Whether the car follows a path and its log has the cross-track error.
bool HasErrorScale(const Recording& recording);

/// The car's cross-track error as fractions of Scales::error, one per recorded state, in steps so
/// coarse that long stretches keep one color, and with hysteresis: what sways between two steps
/// stays at one. Needs HasErrorScale.
std::vector<double> ErrorFractions(const Recording& recording);

/// The car's trail in these colors; nothing without a path.
OverlayEntry ErrorOverlay();

}  // namespace trackbed::render
