#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "render/image.h"

namespace trackbed::render {

/// A font whose large black-and-white glyphs are averaged down to any smaller size. Unlike text
/// drawn by MuJoCo, text in this font has smooth edges.
class Font {
 public:
  static constexpr char kFirst = ' ';
  static constexpr char kLast = '~';

  /// The argument `glyphs` has an image for each character from kFirst to kLast, white on black,
  /// all of equal height.
  explicit Font(std::vector<Image> glyphs);

  /// Returns the width [px] of a line of text whose glyph cells are `size` px high. A character
  /// without a glyph is drawn as '?'.
  [[nodiscard]] double Width(std::string_view text, double size) const;

  /// Coverage of each pixel in the cell of one character, from 0 to 255, with rows from the top.
  struct Mask {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> coverage;
  };
  /// Returns the mask of a glyph, which is computed at the first use of a size and then cached.
  const Mask& GlyphMask(char character, double size);
  [[nodiscard]] double Advance(char character, double size) const;

 private:
  static std::size_t Index(char character);

  std::vector<Image> glyphs_;
  std::map<double, std::vector<Mask>> masks_;
};

/// Position in an image [px], measured from the top left corner.
struct CanvasPoint {
  double x = 0;
  double y = 0;
};

/// Draws two-dimensional shapes and text on an image. Coordinates are in pixels from the top left
/// corner; shapes are clipped at the image's edges.
class Canvas {
 public:
  Canvas(Image& image, Font& font) : image_(image), font_(font) {}

  struct Rectangle {
    double left = 0;
    double top = 0;
    double width = 0;
    double height = 0;
  };

  /// Draws a filled rectangle with smooth rounded corners.
  void Fill(const Rectangle& rectangle, double radius, Color color, double alpha);

  /// Draws an arrow with the given length and middle point. An arrow with `direction` 0 points to
  /// the right, and with pi/2 up.
  void Arrow(double middle_x, double middle_y, double length, double direction, Color color);

  /// Draws a polyline with smooth edges and round ends and joints.
  void Stroke(const std::vector<CanvasPoint>& points, double width, Color color, double alpha);

  /// Draws a filled convex polygon with smooth edges. The corners of the polygon may be given in
  /// clockwise or counterclockwise order.
  void FillConvex(const std::vector<CanvasPoint>& corners, Color color, double alpha);

  /// Draws one line of text; `left` and `top` are the corner of the first glyph cell. Capital
  /// letters extend from about a fifth to three quarters of the cell's height. Returns the
  /// horizontal position at which the next character would be drawn [px].
  double Text(double left, double top, std::string_view text, double size, Color color);

 private:
  /// A rectangle of pixels, without the pixels in column `right` and row `bottom`.
  struct Box {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;
  };
  /// Returns the bounding box of the points, enlarged by `reach` [px] on each side and clipped to
  /// the image.
  [[nodiscard]] Box BoxAround(const std::vector<CanvasPoint>& points, double reach) const;
  void Blend(int x, int y, Color color, double alpha);

  Image& image_;
  Font& font_;
};

}  // namespace trackbed::render
