#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Throws InputError, because an FMU contains its scenario and its car, and has no folder of
/// models.
const char* PlaceOfData() {
  throw InputError(
      Problem{.message = "an FMU has no models but its own; export the FMU again with the other "
                         "model"});
}

}  // namespace trackbed
