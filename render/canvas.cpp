#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

/// Average over the part of the glyph that falls on one pixel of the smaller mask.
std::uint8_t AverageOver(const Image& glyph, double left, double top, double step) {
  const double right = std::min(left + step, static_cast<double>(glyph.width));
  const double bottom = std::min(top + step, static_cast<double>(glyph.height));
  double sum = 0.0;
  for (int y = static_cast<int>(top); y < bottom; ++y) {
    const double rows = std::min(bottom, y + 1.0) - std::max(top, static_cast<double>(y));
    for (int x = static_cast<int>(left); x < right; ++x) {
      const double columns = std::min(right, x + 1.0) - std::max(left, static_cast<double>(x));
      sum += rows * columns * *glyph.Pixel(x, y);
    }
  }
  return static_cast<std::uint8_t>(std::lround(std::clamp(sum / (step * step), 0.0, 255.0)));
}

}  // namespace

Font::Font(std::vector<Image> glyphs) : glyphs_(std::move(glyphs)) {
  TRACKBED_CHECK(glyphs_.size() == kLast - kFirst + 1, "a font of {} glyphs", glyphs_.size());
}

std::size_t Font::Index(char character) {
  const char known = character < kFirst || character > kLast ? '?' : character;
  return static_cast<std::size_t>(known - kFirst);
}

double Font::Advance(char character, double size) const {
  const Image& glyph = glyphs_[Index(character)];
  return glyph.width * size / glyph.height;
}

double Font::Width(std::string_view text, double size) const {
  double width = 0.0;
  for (const char character : text) {
    width += Advance(character, size);
  }
  return width;
}

const Font::Mask& Font::MaskOf(char character, double size) {
  std::vector<Mask>& masks = masks_[size];
  if (masks.empty()) {
    for (const Image& glyph : glyphs_) {
      const double step = glyph.height / size;
      Mask mask;
      mask.width = static_cast<int>(std::ceil(glyph.width / step));
      mask.height = static_cast<int>(std::ceil(size));
      for (int y = 0; y < mask.height; ++y) {
        for (int x = 0; x < mask.width; ++x) {
          mask.coverage.push_back(AverageOver(glyph, x * step, y * step, step));
        }
      }
      masks.push_back(std::move(mask));
    }
  }
  return masks[Index(character)];
}

void Canvas::Blend(int x, int y, Color color, double alpha) {
  if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) {
    return;
  }
  std::uint8_t* pixel = image_.Pixel(x, y);
  const std::array<float, 3> rgb{color.r, color.g, color.b};
  for (const float channel : rgb) {
    // Rounds what is never negative: std::lround takes ten times as long.
    *pixel = static_cast<std::uint8_t>(
        *pixel + alpha * (255.0 * static_cast<double>(channel) - *pixel) + 0.5);
    ++pixel;
  }
}

void Canvas::Fill(const Rectangle& rectangle, double radius, Color color, double alpha) {
  const double center_x = rectangle.left + 0.5 * rectangle.width;
  const double center_y = rectangle.top + 0.5 * rectangle.height;
  for (int y = static_cast<int>(rectangle.top); y < rectangle.top + rectangle.height; ++y) {
    for (int x = static_cast<int>(rectangle.left); x < rectangle.left + rectangle.width; ++x) {
      // Signed distance of the pixel's centre from the rounded outline: one pixel of fading.
      const double across = std::abs(x + 0.5 - center_x) - 0.5 * rectangle.width + radius;
      const double down = std::abs(y + 0.5 - center_y) - 0.5 * rectangle.height + radius;
      const double outside =
          (across > 0.0 && down > 0.0 ? std::hypot(across, down) : std::max(across, down)) - radius;
      Blend(x, y, color, alpha * std::clamp(0.5 - outside, 0.0, 1.0));
    }
  }
}

void Canvas::Arrow(double middle_x, double middle_y, double length, double direction, Color color) {
  // Along the arrow from its middle, and beside it, in lengths.
  constexpr double kNeck = 0.10;
  constexpr double kShaft = 0.08;
  constexpr double kHead = 0.26;
  const auto is_inside = [](double along, double beside) {
    return std::abs(along) <= 0.5 &&
           std::abs(beside) <= (along < kNeck ? kShaft : kHead * (0.5 - along) / (0.5 - kNeck));
  };
  constexpr int kSamples = 4;  // along each side of a pixel
  const double reach = 0.6 * length;
  const double cosine = std::cos(direction);
  const double sine = std::sin(direction);
  for (int y = static_cast<int>(middle_y - reach); y <= middle_y + reach; ++y) {
    for (int x = static_cast<int>(middle_x - reach); x <= middle_x + reach; ++x) {
      int inside = 0;
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const double right = (x + (i % kSamples + 0.5) / kSamples - middle_x) / length;
        const double up = (middle_y - y - (i / kSamples + 0.5) / kSamples) / length;
        inside += is_inside(right * cosine + up * sine, up * cosine - right * sine) ? 1 : 0;
      }
      if (inside > 0) {
        Blend(x, y, color, static_cast<double>(inside) / (kSamples * kSamples));
      }
    }
  }
}

double Canvas::Text(double left, double top, std::string_view text, double size, Color color) {
  double pen = left;
  const int first_row = static_cast<int>(std::lround(top));
  for (const char character : text) {
    const Font::Mask& mask = font_.MaskOf(character, size);
    const int first_column = static_cast<int>(std::lround(pen));
    for (int y = 0; y < mask.height; ++y) {
      for (int x = 0; x < mask.width; ++x) {
        const std::size_t index =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) +
            static_cast<std::size_t>(x);
        if (mask.coverage[index] > 0) {
          Blend(first_column + x, first_row + y, color, mask.coverage[index] / 255.0);
        }
      }
    }
    pen += font_.Advance(character, size);
  }
  return pen;
}

}  // namespace trackbed::render
