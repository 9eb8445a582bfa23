#include "trackbed/scenario/keys.h"

#include "src/scenario/identification_visit.h"
#include "src/scenario/key_lister.h"
#include "src/scenario/study_visit.h"
#include "src/scenario/visit.h"
#include "trackbed/recording/log_map.h"

namespace trackbed {

std::vector<KeySection> ScenarioKeys() {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {"", "", "the whole file", {}});
  Scenario defaults;
  Visit(lister, defaults);
  return sections;
}

std::vector<KeySection> StudyKeys() {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {"", "", "the whole file", {}});
  StudyFile defaults;
  Visit(lister, defaults);
  KeyLister range(sections, {"vary.KEY", "", "evenly spaced values instead of a list", {}});
  GridRange none;
  Visit(range, none);
  for (const auto& [kind, name] : DistributionNames()) {
    KeyLister sampled(sections, {"vary.KEY", name, "values that are sampled", {}});
    Distribution distribution{.kind = kind};
    Visit(sampled, distribution);
  }
  KeyLister of_file(sections, {"vary.KEY", kFileDistribution, "values that are sampled", {}});
  TableColumn column;
  Visit(of_file, column);
  return sections;
}

std::vector<KeySection> IdentificationKeys() {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {"", "", "the whole file", {}});
  Identification defaults;
  Visit(lister, defaults);
  return sections;
}

std::vector<KeySection> LogMapKeys() {
  std::vector<KeySection> sections;
  KeyLister lister(sections, {"", "", "the whole file", {}});
  LogMap defaults;
  Visit(lister, defaults);
  return sections;
}

}  // namespace trackbed
