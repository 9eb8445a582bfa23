#include "render/video.h"
#include "trackbed/render/film.h"

namespace trackbed {

std::string VideoEncoder() {
  return "off";
}

render::OpenOutput render::VideoOpener() {
  return nullptr;
}

render::OpenOutput render::WebpOpener() {
  return nullptr;
}

render::OpenOutput render::ApngOpener() {
  return nullptr;
}

}  // namespace trackbed
