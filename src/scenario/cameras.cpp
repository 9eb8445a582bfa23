#include "trackbed/scenario/cameras.h"

namespace trackbed {

const std::vector<CameraName>& CameraNames() {
  static const std::vector<CameraName> names{
      {"chase", "behind and above the car, turning with it; swings round in reverse"},
      {"side", "from the car's right, a little above, going along with it"},
      {"driver", "from the driver's seat, turning with the car"},
      {"orbit", "once around the car in 24 s"},
      {"top", "straight down, north up: the whole route if it is small, else around the car"},
  };
  return names;
}

}  // namespace trackbed
