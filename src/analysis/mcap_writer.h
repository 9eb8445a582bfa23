#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace trackbed {

/// Writes an MCAP container (mcap.dev/spec). Schemas and channels come first, then uncompressed
/// chunks of messages with one index each, then the summary used for seeking. Numbers are
/// little-endian; all checksums are filled in.
class McapWriter {
 public:
  McapWriter();

  /// Adds a channel before the first message. Channels share a schema if its name and shape are
  /// equal. AddChannel must precede all messages.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema,
                           const nlohmann::json& shape);

  /// Adds a message to a channel. Message times [s] must be non-negative and in ascending order.
  void AddMessage(std::uint16_t channel, double time, const nlohmann::json& message);

  /// Returns the content of the MCAP file. Finish must be the last call on an McapWriter.
  std::string Finish();

 private:
  struct Times {
    std::uint64_t first = 0;  ///< [ns]
    std::uint64_t last = 0;   ///< [ns]
  };

  void CloseChunk();
  std::string SummaryAt(std::size_t start);
  [[nodiscard]] std::string Statistics() const;

  std::string out_;
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_;  ///< Schemas, keyed by
                                                                          ///< name and shape.
  std::vector<std::uint32_t> counts_;  ///< Number of messages by channel.
  std::string schema_records_;
  std::string channel_records_;
  std::string chunk_;
  Times chunk_times_;
  /// Time of each message [ns] and its offset in the current chunk [bytes], by channel.
  std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_messages_;
  std::uint32_t chunks_ = 0;
  std::string chunk_index_records_;
  Times times_;
};

}  // namespace trackbed
