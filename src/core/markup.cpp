#include "src/core/markup.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>

namespace trackbed {
namespace {

/// Returns the name of the first XML or HTML element after comments and declarations; "" if the
/// text has no element.
std::string FirstElement(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n";
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(kSpaces), text.size()));
    const bool is_comment = text.starts_with("<!--");
    const std::size_t end = text.find(is_comment ? "-->" : ">");
    if (!text.starts_with('<') || end == std::string_view::npos) {
      return "";
    }
    if (!is_comment && !text.starts_with("<?") && !text.starts_with("<!")) {
      constexpr std::size_t kLongest = 60;
      return std::string(text.substr(1, text.find_first_of(" \t\r\n/>") - 1).substr(0, kLongest));
    }
    text.remove_prefix(end + (is_comment ? 3 : 1));
  }
}

}  // namespace

bool IsWebPage(std::string_view text) {
  return boost::iequals(FirstElement(text), "html");
}

std::string MarkupProblem(std::string_view text) {
  const std::string element = FirstElement(text);
  if (element.empty()) {
    return "";
  }
  if (IsWebPage(text)) {
    return "a web page instead of a table; download the file itself";
  }
  return fmt::format("XML with the root element {} instead of a table; {}", element,
                     element == "TrainingCenterDatabase"
                         ? "convert Garmin's TCX to GPX, as by: gpsbabel -i gtrnctr -f FILE -o gpx "
                           "-F FILE.gpx"
                         : "GPX, KML, Lanelet2 and CommonRoad files are read if their names end "
                           "with .gpx, .kml, .osm or .xml");
}

}  // namespace trackbed
