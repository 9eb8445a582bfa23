#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Throws InputError. This version of PlaceOfData is for programs that link the static libraries
/// without CMake; in such programs, the folder of the package is unknown.
const char* PlaceOfData() {
  throw InputError(Problem{
      .message = "the folder of models/ and scenarios/ is not known: set the environment variable "
                 "TRACKBED_DATA to it (`pkg-config --variable=pkgdatadir trackbed` prints it)"});
}

}  // namespace trackbed
