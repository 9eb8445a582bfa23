#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "trackbed/bag/bag.h"

namespace trackbed {

/// Largest size of a record or of a decompressed chunk [bytes].
inline constexpr std::size_t kMaxChunkBytes = std::size_t{256} << 20U;
inline constexpr std::size_t kMaxBagTopics = 10'000;

/// Returns the topic of `content` that has the name of `topic`; adds `topic` if the name is new.
/// Throws InputError if the topic has another type, or if there are too many topics.
BagTopic& TopicOf(BagContent& content, const BagTopic& topic, const std::filesystem::path& file);

/// Throws InputError with the message `message` about the file `file` of a bag.
[[noreturn]] void RefuseBag(const std::filesystem::path& file, std::string message);

}  // namespace trackbed
