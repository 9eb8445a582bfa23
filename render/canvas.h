#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "render/image.h"

namespace trackbed::render {

/// A font made of large one-bit glyphs, averaged down to any smaller size: smooth edges that
/// MuJoCo's own text does not have.
class Font {
 public:
  static constexpr char kFirst = ' ';
  static constexpr char kLast = '~';

  /// `glyphs` are the characters kFirst to kLast, white on black, all of one height.
  explicit Font(std::vector<Image> glyphs);

  /// Width of a line of text [px] whose glyph cells are `size` px high. Characters without a glyph
  /// count as '?'.
  [[nodiscard]] double Width(std::string_view text, double size) const;

  /// Coverage in [0, 255] of one character's cell, rows from the top.
  struct Mask {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> coverage;
  };
  /// Made at the first use of a size, kept after.
  const Mask& GlyphMask(char character, double size);
  [[nodiscard]] double Advance(char character, double size) const;

 private:
  static std::size_t Index(char character);

  std::vector<Image> glyphs_;
  std::map<double, std::vector<Mask>> masks_;
};

/// A place in a picture [px], from its top left corner.
struct CanvasPoint {
  double x = 0;
  double y = 0;
};

/// Draws flat shapes and text on a picture. Coordinates are pixels from the top left; what lies
/// outside is cut off.
class Canvas {
 public:
  Canvas(Image& image, Font& font) : image_(image), font_(font) {}

  struct Rectangle {
    double left = 0;
    double top = 0;
    double width = 0;
    double height = 0;
  };

  /// A filled rectangle with smooth round corners.
  void Fill(const Rectangle& rectangle, double radius, Color color, double alpha);

  /// An arrow of `length` around its middle, pointing along `direction`: 0 to the right, pi/2 up.
  void Arrow(double middle_x, double middle_y, double length, double direction, Color color);

  /// A line through the points with round ends and corners and smooth edges.
  void Stroke(const std::vector<CanvasPoint>& points, double width, Color color, double alpha);

  /// A convex shape with smooth edges, its corners in either order.
  void FillConvex(const std::vector<CanvasPoint>& corners, Color color, double alpha);

  /// One line of text, `left` and `top` of its first glyph cell; capitals fill the cell from about
  /// a fifth to three quarters of its height. Returns where the next character would begin.
  double Text(double left, double top, std::string_view text, double size, Color color);

 private:
  /// Whole pixels, the last ones excluded.
  struct Box {
    int left = 0;
    int top = 0;
    int right = 0;
    int bottom = 0;
  };
  /// What of the picture lies within `reach` of the points.
  [[nodiscard]] Box BoxAround(const std::vector<CanvasPoint>& points, double reach) const;
  void Blend(int x, int y, Color color, double alpha);

  Image& image_;
  Font& font_;
};

}  // namespace trackbed::render
