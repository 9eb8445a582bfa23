#pragma once

#include "render/canvas.h"
#include "render/recording.h"

namespace trackbed::render {

/// Draws the path as a straight line from left to right, and each plant's car at its logged station
/// and cross-track error. Lateral distances are enlarged ten times.
///
/// Shows 40 m of the path, three quarters of it behind the car. The view shows more of the path if
/// the largest distance of the run needs it. The view skips plants whose logs lack s_m or
/// cross_track_m.
class LateralView {
 public:
  static constexpr double kMagnification = 10.0;

  /// The recording must outlive the view.
  explicit LateralView(const Recording& recording) : recording_(recording) {}

  /// Draws the whole picture of the lateral view.
  void Draw(Image& image, Font& font, double time) const;

  /// Pixel position of a station and of a distance from the path, positive to the left. `car` is
  /// the station of the car [m].
  [[nodiscard]] CanvasPoint Place(int width, int height, double car, double station,
                                  double left) const;

 private:
  [[nodiscard]] double PixelsPerMeter(int width, int height) const;  // along the path
  void DrawAxes(Canvas& canvas, Font& font, int width, int height, double car) const;

  const Recording& recording_;
};

}  // namespace trackbed::render
