#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "src/bag/topics.h"
#include "trackbed/bag/bag.h"

namespace trackbed {

/// Callback that receives a message of a bag and its topic.
using TakeTopicMessage =
    std::function<void(const BagTopic& topic, std::string_view data, std::int64_t log_time)>;

/// Reads an MCAP file. Adds the topics of the MCAP file to `content`. Calls the callback `take`, if
/// not empty, for each message. BagTopic::messages counts the messages.
void ReadMcap(const std::filesystem::path& file, BagContent& content, const TakeTopicMessage& take);

/// Reads the topics of a SQLite bag file. If the callback `take` is not empty, also reads the
/// messages of the topic `wanted`.
void ReadSqlite(const std::filesystem::path& file, BagContent& content, const std::string& wanted,
                const TakeTopicMessage& take);

}  // namespace trackbed
