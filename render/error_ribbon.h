#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "render/image.h"
#include "render/recording.h"

/// A trail in the colors of how far from the path it is.
namespace trackbed::render {

/// Colors from on the path to Scales::error.
inline constexpr std::array<Color, 5> kErrorColors{{{0.10F, 0.62F, 0.36F},
                                                    {0.58F, 0.78F, 0.22F},
                                                    {0.99F, 0.80F, 0.16F},
                                                    {0.96F, 0.46F, 0.12F},
                                                    {0.80F, 0.08F, 0.16F}}};

/// The color of a share of the scale, in [0, 1].
Color ErrorColor(double share);

/// Shares of Scales::error, which must not be 0, along the car's drive, one per recorded state, in
/// steps so coarse that long stretches keep one color, and with hysteresis: what sways between two
/// steps stays at one.
std::vector<double> ErrorShares(const Recording& recording);

}  // namespace trackbed::render
