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

/// The interface of overlays: what is drawn over the recorded world. docs/how-to/add-an-overlay.md
/// adds one.
namespace trackbed::render {

/// How a color is shown in the legend.
enum class LegendSymbol {
  kLine,     ///< a line on the ground
  kOutline,  ///< the outline of an area or a box
  kDiamond,  ///< a mark on the ground
  kCross,    ///< another one
  kDial,     ///< a dial of the friction used
};

/// What a color in the picture stands for.
struct LegendEntry {
  Color color;
  std::string text;
  std::string note{};         ///< a second line; may be empty
  std::vector<Color> ramp{};  ///< in place of the color, from left to right
  LegendSymbol symbol = LegendSymbol::kLine;
};

/// The world posed for one picture, to which overlays add shapes.
struct SceneContext {
  mjvScene& scene;
  double time;               ///< [s]
  const CameraPose& camera;  ///< where the picture is taken from
  mjvCamera& view;           ///< the same, as MuJoCo has it
  const mjvOption& visible;  ///< which parts of a model are shown
};

/// A drawn picture, over which overlays draw.
struct PictureContext {
  Image& image;
  Font& font;
  double time;  ///< [s]
  const CameraPose& camera;
  const mjData& car;  ///< the car at `time`
  const std::vector<LegendEntry>& legend;
  double top;     ///< where panels along the upper edge end [px]; such a panel moves it down
  double bottom;  ///< where panels along the lower edge begin [px]; such a panel moves it up
  double left;    ///< where there is room above `bottom` [px]; what stands there moves it right
};

/// One thing drawn over the world of one recording. The defaults draw nothing.
class Overlay {
 public:
  Overlay() = default;
  virtual ~Overlay() = default;
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// At most how many shapes AddShapes adds.
  [[nodiscard]] virtual std::size_t max_shapes() const { return 0; }
  /// Adds shapes to the world, where the car and what else stands there hides and shades them; for
  /// the picture and for its inset.
  virtual void AddShapes(SceneContext& /*context*/) {}
  /// Draws flat over the picture, but not over its inset.
  virtual void Draw(PictureContext& /*context*/) {}
  /// Adds its colors to the legend, whose first entry is the car's.
  virtual void AddLegend(std::vector<LegendEntry>& /*legend*/) const {}
};
using OverlayList = std::vector<std::unique_ptr<Overlay>>;

/// What overlays are made for: one recording, in pictures of one size.
struct OverlaySetup {
  const Recording& recording;             ///< outlives the overlay
  const std::vector<std::string>& shown;  ///< the names of all overlays of the film
  std::string title;                      ///< of the picture
  int width = 0;                          ///< [px]
  int height = 0;                         ///< [px]
  Font& font;

  [[nodiscard]] bool Shows(std::string_view name) const {
    return std::find(shown.begin(), shown.end(), name) != shown.end();
  }
};

/// An overlay in the table.
struct OverlayEntry {
  std::string name;
  std::string summary;  ///< for people, on one line
  std::unique_ptr<Overlay> (*make)(const OverlaySetup& setup);
  bool by_default = true;  ///< whether films have it that do not say
};

/// The entry of an overlay whose constructor takes the setup.
template <typename Own>
OverlayEntry EntryOf(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [](const OverlaySetup& setup) -> std::unique_ptr<Overlay> {
            return std::make_unique<Own>(setup);
          }};
}

}  // namespace trackbed::render
