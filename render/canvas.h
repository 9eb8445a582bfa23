#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "render/image.h"

namespace trackbed::render {

/// A font of large one-bit glyphs, averaged down to any smaller size. Unlike MuJoCo's text, text in
/// this font has smooth edges.
class Font {
 public:
  static constexpr char kFirst = ' ';
  static constexpr char kLast = '~';

  /// `glyphs` are the characters kFirst to kLast, white on black, of equal height.
  explicit Font(std::vector<Image> glyphs);

  /// Width of a line of text [px] in glyph cells `size` px high. Characters without a glyph are
  /// drawn as '?'.
  [[nodiscard]] double Width(std::string_view text, double size) const;

  /// Coverage in [0, 255] of one character's cell, rows from the top.
  struct Mask {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> coverage;
  };
  /// Mask of a glyph, computed at the first use of a size, then cached.
  const Mask& GlyphMask(char character, double size);
  [[nodiscard]] double Advance(char character, double size) const;

 private:
  static std::size_t Index(char character);

  std::vector<Image> glyphs_;
  std::map<double, std::vector<Mask>> masks_;
};

/// A position in a picture [px], from its top left corner.
struct CanvasPoint {
  double x = 0;
  double y = 0;
};

/// Draws flat shapes and text on a picture. Coordinates are pixels from the top left; shapes are
/// clipped at the picture's edges.
class Canvas {
 public:
  Canvas(Image& image, Font& font) : image_(image), font_(font) {}

  struct Rectangle {
    double left = 0;
    double top = 0;
    double width = 0;
    double height = 0;
  };

  /// A filled rectangle with smooth rounded corners.
  void Fill(const Rectangle& rectangle, double radius, Color color, double alpha);

  /// Draws an arrow of `length` about its middle, along `direction`: 0 to the right, pi/2 up.
  void Arrow(double middle_x, double middle_y, double length, double direction, Color color);

  /// A polyline with round ends and joints and smooth edges.
  void Stroke(const std::vector<CanvasPoint>& points, double width, Color color, double alpha);

  /// A convex polygon with smooth edges, its corners in either orientation.
  void FillConvex(const std::vector<CanvasPoint>& corners, Color color, double alpha);

  /// Draws one line of text; `left` and `top` are the corner of the first glyph cell. Capitals
  /// occupy about a fifth to three quarters of the cell's height. Returns the position of the next
  /// character.
  double Text(double left, double top, std::string_view text, double size, Color color);

 private:
  /// A range of pixels, excluding `right` and `bottom`.
  struct Box {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;
  };
  /// The part of the picture within `reach` [px] of the points.
  [[nodiscard]] Box BoxAround(const std::vector<CanvasPoint>& points, double reach) const;
  void Blend(int x, int y, Color color, double alpha);

  Image& image_;
  Font& font_;
};

}  // namespace trackbed::render
