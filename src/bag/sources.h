#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "trackbed/bag/bag.h"

namespace trackbed {

/// Receives a message and its topic.
using TakeTopicMessage =
    std::function<void(const BagTopic& topic, std::string_view data, std::int64_t log_time)>;

/// Reads a MCAP file. Adds its topics to `content`, and calls `take` for each message, if `take` is
/// not empty. BagTopic::messages counts the messages.
void ReadMcap(const std::filesystem::path& file, BagContent& content, const TakeTopicMessage& take);

/// Reads the topics of a SQLite file, and the messages of the topic `wanted`, if `take` is not
/// empty.
void ReadSqlite(const std::filesystem::path& file, BagContent& content, const std::string& wanted,
                const TakeTopicMessage& take);

/// Returns the topic of `content` that has the name of `topic`; adds `topic` if the name is new.
/// Throws InputError if the topic has another type, or if there are too many topics.
BagTopic& TopicOf(BagContent& content, const BagTopic& topic, const std::filesystem::path& file);

/// Decompresses a frame of lz4 or zstd to at most `largest` bytes. Throws InputError if the frame
/// is damaged or larger.
std::string Decompress(std::string_view data, const std::string& compression, std::size_t largest,
                       const std::filesystem::path& file);

/// Largest size of a record or of a decompressed chunk [bytes].
inline constexpr std::size_t kMaxChunkBytes = std::size_t{256} << 20U;
inline constexpr std::size_t kMaxBagTopics = 10'000;

[[noreturn]] void RefuseBag(const std::filesystem::path& file, std::string message);

}  // namespace trackbed
