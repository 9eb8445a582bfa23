#pragma once

#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/recording.h"

/// Interface of overlays, which draw over the recorded world. See docs/how-to/add-an-overlay.md.
namespace trackbed::render {

/// Symbol that shows a color in the legend.
enum class LegendSymbol {
  kLine,     ///< A line on the ground.
  kOutline,  ///< Outline of an area or a box.
  kDiamond,  ///< A mark on the ground.
  kCross,    ///< A cross on the ground.
  kDial,     ///< A dial that shows the used friction of a tyre.
};

/// An entry of the legend, which explains a color in the picture.
struct LegendEntry {
  Color color;
  std::string text;
  std::string note{};         ///< Second line of the entry; may be empty.
  std::vector<Color> ramp{};  ///< Color scale from left to right, shown instead of a single color.
  LegendSymbol symbol = LegendSymbol::kLine;
};

/// The scene of one picture, to which overlays add shapes.
struct SceneContext {
  mjvScene& scene;
  double time;               ///< Time of the picture [s].
  const CameraPose& camera;  ///< Camera of the picture.
  mjvCamera& view;           ///< The picture's camera in MuJoCo's format.
  const mjvOption& visible;  ///< Which parts of a model are visible.
};

/// A rendered picture on which overlays draw.
struct PictureContext {
  Image& image;
  Font& font;
  double time;  ///< [s]
  const CameraPose& camera;
  const mjData& car;  ///< MuJoCo's data of the car at `time`
  const std::vector<LegendEntry>& legend;
  double top;     ///< Lower end of the panels at the picture's upper edge [px]; each new panel
                  ///< increases `top`.
  double bottom;  ///< Upper end of the panels at the picture's lower edge [px]; each new panel
                  ///< decreases `bottom`.
  double left;    ///< Left end of the free space just above `bottom` [px]; each new panel there
                  ///< increases `left`.
};

/// Base class of overlays, which draw something over the world of one recording. The default
/// functions draw nothing.
class Overlay {
 public:
  Overlay() = default;
  virtual ~Overlay() = default;
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Returns the maximum number of shapes that AddShapes adds to a scene.
  [[nodiscard]] virtual std::size_t max_shapes() const { return 0; }
  /// Adds shapes to the 3D scene, where the car and other objects can hide and shade them. The
  /// picture's inset also shows these shapes.
  virtual void AddShapes(SceneContext& /*context*/) {}
  /// Draws two-dimensional shapes over the picture, but not over its inset.
  virtual void Draw(PictureContext& /*context*/) {}
  /// Adds this overlay's entries to the legend, whose first entry is the car.
  virtual void AddLegend(std::vector<LegendEntry>& /*legend*/) const {}
};
using OverlayList = std::vector<std::unique_ptr<Overlay>>;

/// Arguments for making the overlays of one recording, for pictures of one size.
struct OverlaySetup {
  const Recording& recording;             ///< The recording must outlive the overlay.
  const std::vector<std::string>& shown;  ///< Names of all overlays of the film.
  std::string title;                      ///< Title of the picture.
  int width = 0;                          ///< Width of the picture [px].
  int height = 0;                         ///< Height of the picture [px].
  Font& font;

  [[nodiscard]] bool Shows(std::string_view name) const {
    return std::find(shown.begin(), shown.end(), name) != shown.end();
  }
};

/// An entry of the overlay table.
struct OverlayEntry {
  std::string name;
  std::string summary;  ///< one-line summary for users
  std::unique_ptr<Overlay> (*make)(const OverlaySetup& setup);
  bool by_default = true;  ///< whether films show the overlay by default
};

/// Makes the table entry of an overlay class whose constructor takes an OverlaySetup.
template <typename Own>
OverlayEntry MakeOverlayEntry(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [](const OverlaySetup& setup) -> std::unique_ptr<Overlay> {
            return std::make_unique<Own>(setup);
          }};
}

}  // namespace trackbed::render
