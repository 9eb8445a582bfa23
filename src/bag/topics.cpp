#include "src/bag/topics.h"

#include <fmt/format.h>

#include <algorithm>

#include "trackbed/core/error.h"

namespace trackbed {

namespace fs = std::filesystem;

void RefuseBag(const fs::path& file, std::string message) {
  throw InputError(Problem{.file = file.string(), .message = std::move(message)});
}

BagTopic& TopicOf(BagContent& content, const BagTopic& topic, const fs::path& file) {
  const auto place = std::lower_bound(
      content.topics.begin(), content.topics.end(), topic.name,
      [](const BagTopic& own, const std::string& name) { return own.name < name; });
  if (place != content.topics.end() && place->name == topic.name) {
    if (!topic.type.empty() && topic.type != place->type) {
      RefuseBag(file, fmt::format("the topic {} has the types {} and {}", topic.name, place->type,
                                  topic.type));
    }
    return *place;
  }
  if (content.topics.size() >= kMaxBagTopics) {
    RefuseBag(file, fmt::format("more than {} topics", kMaxBagTopics));
  }
  return *content.topics.insert(place, topic);
}

}  // namespace trackbed
