#include "render/insets.h"

#include "render/lateral.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {

const std::vector<FlatView>& FlatViewTable() {
  static const std::vector<FlatView> table{
      {"lateral", "flat: the path straightened, distances from it ten times enlarged",
       [](const Recording& recording, Image& image, Font& font, double time) {
         LateralView(recording).Draw(image, font, time);
       }},
  };
  return table;
}

Inset FindInset(const std::string& name) {
  std::vector<std::string> names;
  for (const Camera& camera : CameraTable()) {
    if (camera.name == name) {
      return {.camera = &camera};
    }
    names.emplace_back(camera.name);
  }
  for (const FlatView& view : FlatViewTable()) {
    if (view.name == name) {
      return {.view = &view};
    }
    names.emplace_back(view.name);
  }
  throw InputError(Problem{.key = "inset", .message = "unknown inset " + UnknownName(name, names)});
}

}  // namespace trackbed::render
