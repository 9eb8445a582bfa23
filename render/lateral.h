#pragma once

#include "render/canvas.h"
#include "render/recording.h"

namespace trackbed::render {

/// The path drawn as a straight line, from left to right, and each plant's car where its log has
/// it: at its own station, with its distance from the path ten times as large as along it.
///
/// It shows 40 m of the path, three quarters of them behind the car, or so much more that the
/// largest distance of the run has room. Plants whose logs lack s_m or cross_track_m are left out.
class LateralView {
 public:
  static constexpr double kEnlarged = 10.0;

  /// The recording outlives it.
  explicit LateralView(const Recording& recording) : recording_(recording) {}

  /// Fills the picture.
  void Draw(Image& image, Font& font, double time) const;

  /// Where a station and a distance from the path, positive to the left, are in a picture of that
  /// size when the car is at station `car` [m].
  [[nodiscard]] CanvasPoint Place(int width, int height, double car, double station,
                                  double left) const;

 private:
  [[nodiscard]] double PixelsPerMeter(int width, int height) const;  // along the path
  void DrawAxes(Canvas& canvas, Font& font, int width, int height, double car) const;

  const Recording& recording_;
};

}  // namespace trackbed::render
