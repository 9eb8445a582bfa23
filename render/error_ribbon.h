#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "render/image.h"
#include "render/recording.h"

/// A trail in the colours of how far from the path it is.
namespace trackbed::render {

/// Colours from on the path to as far off as the car ever was.
inline constexpr std::array<Color, 5> kErrorColors{{{0.10F, 0.62F, 0.36F},
                                                    {0.58F, 0.78F, 0.22F},
                                                    {0.99F, 0.80F, 0.16F},
                                                    {0.96F, 0.46F, 0.12F},
                                                    {0.80F, 0.08F, 0.16F}}};

/// The colour of a share of the scale, in [0, 1].
Color ErrorColor(double share);

/// The distance from the path that the last colour stands for [m]: the largest of the drive,
/// rounded up to 1, 2 or 5 times a power of ten, and at least 0.05 m. 0 when the car follows no
/// path or its log does not say how far from it it is.
double ErrorScale(const Recording& recording);

/// Shares of the scale along the car's drive, one per recorded state, in steps so coarse that long
/// stretches keep one colour, and with hysteresis: what sways between two steps stays at one.
std::vector<double> ErrorShares(const Recording& recording, double scale);

}  // namespace trackbed::render
