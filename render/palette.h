#pragma once

#include <array>
#include <cstddef>

#include "render/image.h"

/// Colors of a film, where each hue has one meaning: orange for the car, white for the plan, pink
/// for a replaced plan, violet for the wind. The color red shows that a limit is reached. The color
/// blue and the other colors of CarColor are used for the other plants. The cross-track error is
/// shown by a color scale from dark violet over green to yellow (viridis). The hues are taken from
/// Okabe and Ito, "Color universal design" (2008), lightened for contrast with asphalt. People with
/// any common kind of color blindness can distinguish the hues of a film.
namespace trackbed::render {

inline constexpr Color kPlanColor{1.00F, 1.00F, 0.97F};
inline constexpr Color kNewPlanColor{1.00F, 0.58F, 0.80F};
inline constexpr Color kLimitColor{0.88F, 0.15F, 0.10F};
inline constexpr Color kWindColor{0.80F, 0.76F, 1.00F};
inline constexpr Color kGustColor{0.66F, 0.56F, 0.96F};

/// Returns the color of a plant's trail and other marks. Plant 0 is the car; plants with larger
/// indices are ghosts.
constexpr Color CarColor(std::size_t car) {
  constexpr std::array<Color, 5> kColors{{{1.00F, 0.55F, 0.05F},
                                          {0.34F, 0.75F, 0.97F},
                                          {0.00F, 0.62F, 0.45F},
                                          {0.80F, 0.47F, 0.65F},
                                          {0.10F, 0.45F, 0.80F}}};
  return kColors[car < kColors.size() ? car : 1 + (car - 1) % (kColors.size() - 1)];
}

}  // namespace trackbed::render
