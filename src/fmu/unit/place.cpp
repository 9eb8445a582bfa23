#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Throws InputError: an FMU carries its scenario and its car, and needs no folder of models.
const char* PlaceOfData() {
  throw InputError(
      Problem{.message = "an FMU has no models but its own; export the FMU again with the other "
                         "model"});
}

}  // namespace trackbed
