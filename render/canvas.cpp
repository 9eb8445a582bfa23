#include "render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "trackbed/core/error.h"

// Draws anti-aliased shapes: a pixel's coverage is estimated from the signed distance between its
// center and the shape's edge, with a transition one pixel wide. A pixel's coverage by an arrow is
// computed from 4 by 4 samples. Glyphs are large bitmaps that are averaged down to the wanted size.
namespace trackbed::render {
namespace {

/// Returns the mean of the glyph's pixels that are covered by one pixel of the smaller mask.
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

std::array<std::uint8_t, 3> Blended(const std::array<std::uint8_t, 3>& under, Color color,
                                    double alpha) {
  const std::array<float, 3> rgb{color.r, color.g, color.b};
  std::array<std::uint8_t, 3> blended{};
  for (std::size_t i = 0; i < 3; ++i) {
    // Rounds a non-negative number by adding 0.5, since std::lround takes ten times as long.
    const double value = under[i] + alpha * (255.0 * static_cast<double>(rgb[i]) - under[i]);
    blended[i] = static_cast<std::uint8_t>(value + 0.5);  // NOLINT(bugprone-incorrect-roundings)
  }
  return blended;
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

const Font::Mask& Font::GlyphMask(char character, double size) {
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
  const std::array<std::uint8_t, 3> blended = Blended({pixel[0], pixel[1], pixel[2]}, color, alpha);
  std::copy(blended.begin(), blended.end(), pixel);
}

void Canvas::Fill(const Rectangle& rectangle, double radius, Color color, double alpha) {
  const double center_x = rectangle.left + 0.5 * rectangle.width;
  const double center_y = rectangle.top + 0.5 * rectangle.height;
  // The new value of a pixel inside the panel depends only on the old value, so a lookup table is
  // used. Most pixels of a panel are not at its edges.
  const int inner_left = std::max(0, static_cast<int>(std::ceil(rectangle.left + radius)) + 1);
  const int inner_right = std::min(
      image_.width, static_cast<int>(std::floor(rectangle.left + rectangle.width - radius)) - 1);
  std::array<std::array<std::uint8_t, 256>, 3> blended;
  for (std::size_t value = 0; value < 256; ++value) {
    const auto gray = static_cast<std::uint8_t>(value);
    const std::array<std::uint8_t, 3> pixel = Blended({gray, gray, gray}, color, alpha);
    for (std::size_t i = 0; i < 3; ++i) {
      blended[i][value] = pixel[i];
    }
  }
  for (int y = static_cast<int>(rectangle.top); y < rectangle.top + rectangle.height; ++y) {
    const bool is_inner = y >= 0 && y < image_.height && y >= rectangle.top + 1.0 &&
                          y + 2.0 <= rectangle.top + rectangle.height;
    for (int x = static_cast<int>(rectangle.left); x < rectangle.left + rectangle.width; ++x) {
      if (is_inner && x == inner_left && inner_left < inner_right) {
        std::uint8_t* pixel = image_.Pixel(x, y);
        for (; x < inner_right; ++x) {
          for (std::size_t i = 0; i < 3; ++i, ++pixel) {
            *pixel = blended[i][*pixel];
          }
        }
      }
      // Signed distance of the pixel's center from the rounded outline [px]; the edge fades over
      // one pixel.
      const double across = std::abs(x + 0.5 - center_x) - 0.5 * rectangle.width + radius;
      const double down = std::abs(y + 0.5 - center_y) - 0.5 * rectangle.height + radius;
      const double outside =
          (across > 0.0 && down > 0.0 ? std::hypot(across, down) : std::max(across, down)) - radius;
      Blend(x, y, color, alpha * std::clamp(0.5 - outside, 0.0, 1.0));
    }
  }
}

void Canvas::Arrow(double middle_x, double middle_y, double length, double direction, Color color) {
  // Dimensions of an arrow as fractions of the arrow's length: along the arrow from its middle, and
  // across the arrow.
  constexpr double kNeck = 0.10;
  constexpr double kShaft = 0.08;
  constexpr double kHead = 0.26;
  const auto is_inside = [](double along, double beside) {
    return std::abs(along) <= 0.5 &&
           std::abs(beside) <= (along < kNeck ? kShaft : kHead * (0.5 - along) / (0.5 - kNeck));
  };
  constexpr int kSamples = 4;  // number of samples along each side of a pixel
  const double reach = 0.6 * length;
  const double cosine = std::cos(direction);
  const double sine = std::sin(direction);
  for (int y = static_cast<int>(middle_y - reach); y <= middle_y + reach; ++y) {
    for (int x = static_cast<int>(middle_x - reach); x <= middle_x + reach; ++x) {
      int inside = 0;
      for (int i = 0; i < kSamples * kSamples; ++i) {
        const int column = i % kSamples;
        const int row = i / kSamples;
        const double right = (x + (column + 0.5) / kSamples - middle_x) / length;
        const double up = (middle_y - y - (row + 0.5) / kSamples) / length;
        inside += is_inside(right * cosine + up * sine, up * cosine - right * sine) ? 1 : 0;
      }
      if (inside > 0) {
        Blend(x, y, color, static_cast<double>(inside) / (kSamples * kSamples));
      }
    }
  }
}

Canvas::Box Canvas::BoxAround(const std::vector<CanvasPoint>& points, double reach) const {
  double left = image_.width;
  double top = image_.height;
  double right = 0.0;
  double bottom = 0.0;
  for (const CanvasPoint& point : points) {
    left = std::min(left, point.x - reach);
    top = std::min(top, point.y - reach);
    right = std::max(right, point.x + reach + 1.0);
    bottom = std::max(bottom, point.y + reach + 1.0);
  }
  return {static_cast<int>(std::max(0.0, left)), static_cast<int>(std::max(0.0, top)),
          static_cast<int>(std::min<double>(image_.width, right)),
          static_cast<int>(std::min<double>(image_.height, bottom))};
}

void Canvas::Stroke(const std::vector<CanvasPoint>& points, double width, Color color,
                    double alpha) {
  // Half the line's width, plus half a pixel because the edge of a line fades.
  const double reach = 0.5 * width + 0.5;
  const Box all = BoxAround(points, reach);
  if (points.size() < 2 || all.right <= all.left || all.bottom <= all.top) {
    return;
  }
  // Segments of the polyline overlap at their joints, so each pixel gets the maximum coverage of
  // all segments.
  const auto columns = static_cast<std::size_t>(all.right - all.left);
  std::vector<float> covered(columns * static_cast<std::size_t>(all.bottom - all.top));
  for (std::size_t i = 1; i < points.size(); ++i) {
    const CanvasPoint& a = points[i - 1];
    const CanvasPoint& b = points[i];
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double squared = std::max(dx * dx + dy * dy, 1e-12);
    const Box box = BoxAround({a, b}, reach);
    for (int y = box.top; y < box.bottom; ++y) {
      for (int x = box.left; x < box.right; ++x) {
        const double right = x + 0.5 - a.x;
        const double down = y + 0.5 - a.y;
        const double along = std::clamp((right * dx + down * dy) / squared, 0.0, 1.0);
        const double away_x = right - along * dx;
        const double away_y = down - along * dy;
        const double away = away_x * away_x + away_y * away_y;
        if (away < reach * reach) {
          float& most = covered[static_cast<std::size_t>(y - all.top) * columns +
                                static_cast<std::size_t>(x - all.left)];
          most = std::max(most, static_cast<float>(std::min(1.0, reach - std::sqrt(away))));
        }
      }
    }
  }
  for (int y = all.top; y < all.bottom; ++y) {
    for (int x = all.left; x < all.right; ++x) {
      const float share = covered[static_cast<std::size_t>(y - all.top) * columns +
                                  static_cast<std::size_t>(x - all.left)];
      if (share > 0.0F) {
        Blend(x, y, color, alpha * static_cast<double>(share));
      }
    }
  }
}

void Canvas::FillConvex(const std::vector<CanvasPoint>& corners, Color color, double alpha) {
  // twice the polygon's signed area, whose sign tells whether the corners are in counterclockwise
  // order
  double area = 0.0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const CanvasPoint& a = corners[i];
    const CanvasPoint& b = corners[(i + 1) % corners.size()];
    area += a.x * b.y - b.x * a.y;
  }
  struct Edge {
    double across_x;  // unit vector toward the inside of the polygon
    double across_y;
    double offset;
  };
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const CanvasPoint& a = corners[i];
    const CanvasPoint& b = corners[(i + 1) % corners.size()];
    const double length = std::copysign(std::hypot(b.x - a.x, b.y - a.y), area);
    if (length != 0.0) {
      const double across_x = (a.y - b.y) / length;
      const double across_y = (b.x - a.x) / length;
      edges.push_back({across_x, across_y, across_x * a.x + across_y * a.y});
    }
  }
  const auto inside = [&](int x, int y) {
    double share = 1.0;
    for (const Edge& edge : edges) {
      share = std::min(share,
                       edge.across_x * (x + 0.5) + edge.across_y * (y + 0.5) - edge.offset + 0.5);
    }
    return share;
  };
  const Box box = BoxAround(corners, 0.5);
  for (int y = box.top; y < box.bottom; ++y) {
    // Finds the columns of a row that the polygon covers partly, and the columns that it covers
    // fully. The range of partly covered columns has a margin of one pixel for rounding errors.
    // Only the few pixels in partly covered columns are compared with all edges.
    double left = box.left;
    double right = box.right;
    double whole_left = box.left;
    double whole_right = box.right;
    for (const Edge& edge : edges) {
      if (std::abs(edge.across_x) < 1e-9) {
        const double share = edge.across_y * (y + 0.5) - edge.offset + 0.5;
        whole_right = share < 1.0 + 1e-6 * box.right ? whole_left : whole_right;
        continue;
      }
      const double at_half = (edge.offset - edge.across_y * (y + 0.5)) / edge.across_x - 0.5;
      const double fade = 0.5 / std::abs(edge.across_x) + 1.0;
      if (edge.across_x > 0.0) {
        left = std::max(left, at_half - fade);
        whole_left = std::max(whole_left, at_half + fade);
      } else {
        right = std::min(right, at_half + fade);
        whole_right = std::min(whole_right, at_half - fade);
      }
    }
    for (int x = static_cast<int>(left); x < right; ++x) {
      const double share = x >= whole_left && x < whole_right ? 1.0 : inside(x, y);
      if (share > 0.0) {
        Blend(x, y, color, alpha * share);
      }
    }
  }
}

double Canvas::Text(double left, double top, std::string_view text, double size, Color color) {
  double pen = left;
  const int first_row = static_cast<int>(std::lround(top));
  for (const char character : text) {
    const Font::Mask& mask = font_.GlyphMask(character, size);
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
