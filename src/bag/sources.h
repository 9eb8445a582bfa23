#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "src/bag/topics.h"
#include "trackbed/bag/bag.h"

namespace trackbed {

/// Receives a message and its topic.
using TakeTopicMessage =
    std::function<void(const BagTopic& topic, std::string_view data, std::int64_t log_time)>;

/// Reads a MCAP file. Adds the topics of the file to `content`, and calls `take` for each message,
/// if `take` is not empty. BagTopic::messages counts the messages.
void ReadMcap(const std::filesystem::path& file, BagContent& content, const TakeTopicMessage& take);

/// Reads the topics of a SQLite file, and the messages of the topic `wanted`, if `take` is not
/// empty.
void ReadSqlite(const std::filesystem::path& file, BagContent& content, const std::string& wanted,
                const TakeTopicMessage& take);

}  // namespace trackbed
