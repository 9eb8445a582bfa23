#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"

namespace trackbed::render {

/// A picture that is drawn flat, for an inset in place of a second camera.
struct FlatView {
  std::string_view name;
  std::string_view summary;
  /// Fills the picture with the recording at `time` [s].
  void (*draw)(const Recording& recording, Image& image, Font& font, double time);
};

/// The only list of flat views.
const std::vector<FlatView>& FlatViewTable();

/// What an inset shows: one of the two.
struct Inset {
  const Camera* camera = nullptr;
  const FlatView* view = nullptr;
};

/// By the name of a camera or of a flat view. InputError with the nearest name, under `inset`, when
/// there is neither.
Inset FindInset(const std::string& name);

}  // namespace trackbed::render
