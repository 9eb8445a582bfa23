#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "trackbed/bag/bag.h"

namespace trackbed {

/// Largest accepted size of a bag's record or decompressed chunk [bytes].
inline constexpr std::size_t kMaxChunkBytes = std::size_t{256} << 20U;
inline constexpr std::size_t kMaxBagTopics = 10'000;

/// Returns the topic of `content` that has the same name as `topic`; adds `topic` if the name is
/// new. Throws InputError if the existing topic has another message type, or if the bag exceeds the
/// maximum number of topics.
BagTopic& TopicOf(BagContent& content, const BagTopic& topic, const std::filesystem::path& file);

/// Throws InputError with the message `message` about the file `file` of a bag.
[[noreturn]] void RefuseBag(const std::filesystem::path& file, std::string message);

}  // namespace trackbed
