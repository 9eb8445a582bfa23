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

/// The interface of overlays, which draw over the recorded world. See
/// docs/how-to/add-an-overlay.md.
namespace trackbed::render {

/// Symbol of a color in the legend.
enum class LegendSymbol {
  kLine,     ///< a line on the ground
  kOutline,  ///< outline of an area or a box
  kDiamond,  ///< a mark on the ground
  kCross,    ///< another mark on the ground
  kDial,     ///< a dial of the used friction
};

/// Meaning of a color in the picture.
struct LegendEntry {
  Color color;
  std::string text;
  std::string note{};         ///< second line; may be empty
  std::vector<Color> ramp{};  ///< instead of the color, from left to right
  LegendSymbol symbol = LegendSymbol::kLine;
};

/// The world posed for one picture; overlays add shapes to it.
struct SceneContext {
  mjvScene& scene;
  double time;               ///< [s]
  const CameraPose& camera;  ///< camera of the picture
  mjvCamera& view;           ///< the same camera for MuJoCo
  const mjvOption& visible;  ///< which parts of a model are visible
};

/// A rendered picture on which overlays draw.
struct PictureContext {
  Image& image;
  Font& font;
  double time;  ///< [s]
  const CameraPose& camera;
  const mjData& car;  ///< the car at `time`
  const std::vector<LegendEntry>& legend;
  double top;     ///< bottom of the panels at the upper edge [px]; a new panel there increases it
  double bottom;  ///< top of the panels at the lower edge [px]; a new panel there decreases it
  double left;    ///< start of free space above `bottom` [px]; a new panel there increases it
};

/// Something drawn over the world of one recording. By default draws nothing.
class Overlay {
 public:
  Overlay() = default;
  virtual ~Overlay() = default;
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// Maximum number of shapes that AddShapes adds.
  [[nodiscard]] virtual std::size_t max_shapes() const { return 0; }
  /// Adds shapes to the world, where the car and other objects hide and shade them. Also shown in
  /// an inset.
  virtual void AddShapes(SceneContext& /*context*/) {}
  /// Draws flat over the picture, but not over its inset.
  virtual void Draw(PictureContext& /*context*/) {}
  /// Adds entries to the legend, whose first entry is the car.
  virtual void AddLegend(std::vector<LegendEntry>& /*legend*/) const {}
};
using OverlayList = std::vector<std::unique_ptr<Overlay>>;

/// Arguments for making overlays: one recording, in pictures of one size.
struct OverlaySetup {
  const Recording& recording;             ///< must outlive the overlay
  const std::vector<std::string>& shown;  ///< names of all overlays of the film
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
  std::string summary;  ///< one line, shown to users
  std::unique_ptr<Overlay> (*make)(const OverlaySetup& setup);
  bool by_default = true;  ///< whether films show it by default
};

/// The entry of an overlay whose constructor takes the setup.
template <typename Own>
OverlayEntry MakeOverlayEntry(std::string name, std::string summary) {
  return {std::move(name), std::move(summary),
          [](const OverlaySetup& setup) -> std::unique_ptr<Overlay> {
            return std::make_unique<Own>(setup);
          }};
}

}  // namespace trackbed::render
