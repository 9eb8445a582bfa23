#pragma once

#include "render/canvas.h"
#include "render/recording.h"

namespace trackbed::render {

/// A view that shows the path as a straight line from left to right, with each plant's car at its
/// logged station and cross-track error. Lateral distances are magnified ten times.
///
/// The lateral view shows 40 m of the path, of which 30 m are behind the car. If the largest
/// cross-track error of the run does not fit, the lateral view shows a longer part of the path at a
/// smaller scale. Plants whose logs lack the columns s_m or cross_track_m are skipped.
class LateralView {
 public:
  static constexpr double kMagnification = 10.0;

  /// The recording must outlive the lateral view.
  explicit LateralView(const Recording& recording) : recording_(recording) {}

  /// Draws the lateral view at `time` [s] over the whole image.
  void Draw(Image& image, Font& font, double time) const;

  /// Returns the pixel position of a point at station `station` [m] and at a distance `left` to the
  /// left of the path [m]. The argument `car` is the station of the car [m].
  [[nodiscard]] CanvasPoint Place(int width, int height, double car, double station,
                                  double left) const;

 private:
  [[nodiscard]] double PixelsPerMeter(int width, int height) const;  // along the path
  void DrawAxes(Canvas& canvas, Font& font, int width, int height, double car) const;

  const Recording& recording_;
};

}  // namespace trackbed::render
