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

/// Interface of overlays, which draw over the recorded world in a film. The page
/// docs/how-to/add-an-overlay.md shows how to add an overlay.
namespace trackbed::render {

/// Kinds of symbols that show a color in the legend.
enum class LegendSymbol {
  kLine,     ///< Symbol for a line on the ground.
  kOutline,  ///< Symbol for the outline of an area or a box.
  kDiamond,  ///< Symbol for a mark on the ground.
  kCross,    ///< Symbol for a cross on the ground.
  kDial,     ///< Symbol for a dial that shows the used friction of a tyre.
};

/// An entry of the legend, which explains a color in the frame.
struct LegendEntry {
  Color color;
  std::string text;
  std::string note{};  ///< Second line of the legend entry; may be empty.
  /// Color scale of the legend entry from left to right, shown instead of a single color.
  std::vector<Color> ramp{};
  LegendSymbol symbol = LegendSymbol::kLine;
};

/// The 3D scene of one frame, to which overlays add shapes.
struct SceneContext {
  mjvScene& scene;
  double time;               ///< Simulated time that the frame shows [s].
  const CameraPose& camera;  ///< Camera from which the frame is drawn.
  mjvCamera& view;           ///< Camera of the frame in MuJoCo's format.
  /// MuJoCo's options that determine which parts of a model are visible.
  const mjvOption& visible;
};

/// A rendered frame on which overlays draw.
struct PictureContext {
  Image& image;
  Font& font;
  double time;  ///< [s]
  const CameraPose& camera;
  const mjData& car;  ///< MuJoCo's data of the car at the simulated time `time`
  const std::vector<LegendEntry>& legend;
  /// Lower end of the panels at the frame's upper edge [px]; each new panel increases `top`.
  double top;
  /// Upper end of the panels at the frame's lower edge [px]; each new panel decreases `bottom`.
  double bottom;
  /// Left end of the free space directly above `bottom` [px]; each new panel there increases
  /// `left`.
  double left;
};

/// Base class of overlays; an overlay draws something over the world of one recording. By default,
/// an overlay draws nothing and adds nothing to the legend.
class Overlay {
 public:
  Overlay() = default;
  virtual ~Overlay() = default;
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Returns the maximum number of shapes that this overlay adds to a scene in AddShapes.
  [[nodiscard]] virtual std::size_t max_shapes() const { return 0; }
  /// Adds shapes to the 3D scene, where other objects such as the car can hide and shade these
  /// shapes. The inset of the frame also shows the 3D shapes of overlays.
  virtual void AddShapes(SceneContext& /*context*/) {}
  /// Draws two-dimensional shapes over the frame, but not over its inset.
  virtual void Draw(PictureContext& /*context*/) {}
  /// Adds this overlay's entries to the legend, whose first entry is the car.
  virtual void AddLegend(std::vector<LegendEntry>& /*legend*/) const {}
};
using OverlayList = std::vector<std::unique_ptr<Overlay>>;

/// Arguments for making the overlays of one recording, for frames of one size.
struct OverlaySetup {
  /// The recording that the overlay draws; must outlive the overlay.
  const Recording& recording;
  const std::vector<std::string>& shown;  ///< Names of all overlays that the film shows.
  std::string title;                      ///< Title shown in the frame.
  int width = 0;                          ///< Width of the frame [px].
  int height = 0;                         ///< Height of the frame [px].
  Font& font;

  [[nodiscard]] bool Shows(std::string_view name) const {
    return std::find(shown.begin(), shown.end(), name) != shown.end();
  }
};

/// An entry in the table of overlays.
struct OverlayEntry {
  std::string name;
  std::string summary;  ///< one-line summary of the overlay for users
  std::unique_ptr<Overlay> (*make)(const OverlaySetup& setup);
  bool by_default = true;  ///< whether films show this overlay by default
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
