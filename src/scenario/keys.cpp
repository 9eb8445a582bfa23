#include "trackbed/scenario/keys.h"

#include "src/scenario/visit.h"

namespace trackbed {

std::vector<KeySection> ScenarioKeys() {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {"", "", "the whole file", {}});
  Scenario defaults;
  Visit(lister, defaults);
  return sections;
}

}  // namespace trackbed
