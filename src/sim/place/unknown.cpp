#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Throws InputError. This version of PlaceOfData is used in programs that were linked to static
/// libraries without CMake, where the package's folder is unknown.
const char* PlaceOfData() {
  throw InputError(Problem{
      .message = "the folder of models/ and scenarios/ is not known: set the environment variable "
                 "TRACKBED_DATA to it (`pkg-config --variable=pkgdatadir trackbed` prints it)"});
}

}  // namespace trackbed
