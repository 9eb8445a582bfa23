#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace trackbed {

/// Records of the format, written one after the other; all numbers little-endian.
class McapWriter {
 public:
  McapWriter() : out_(kMagic) {
    std::string header;
    PutText(header, "");  // no profile
    PutText(header, "trackbed");
    Record(0x01, header);
  }

  /// A channel of its own; channels of equal schema names share the schema.
  std::uint16_t AddChannel(const std::string& topic, const std::string& schema,
                           const nlohmann::json& shape) {
    const auto [known, is_new] =
        schemas_.emplace(schema, static_cast<std::uint16_t>(schemas_.size() + 1));
    if (is_new) {
      std::string record;
      Put<std::uint16_t>(record, known->second);
      PutText(record, schema);
      PutText(record, "jsonschema");
      PutText(record, shape.dump());
      Record(0x03, record);
    }
    const auto channel = static_cast<std::uint16_t>(sequences_.size());
    sequences_.push_back(0);
    std::string record;
    Put<std::uint16_t>(record, channel);
    Put<std::uint16_t>(record, known->second);
    PutText(record, topic);
    PutText(record, "json");
    Put<std::uint32_t>(record, 0);  // no metadata
    Record(0x04, record);
    return channel;
  }

  void AddMessage(std::uint16_t channel, double time, const nlohmann::json& message) {
    const auto nanoseconds = static_cast<std::uint64_t>(std::llround(time * 1e9));
    std::string record;
    Put<std::uint16_t>(record, channel);
    Put<std::uint32_t>(record, sequences_[channel]++);
    Put<std::uint64_t>(record, nanoseconds);
    Put<std::uint64_t>(record, nanoseconds);
    record += message.dump();
    Record(0x05, record);
  }

  std::string Finish() {
    std::string end;
    Put<std::uint32_t>(end, 0);  // checksums are not available
    Record(0x0F, end);
    std::string footer;
    Put<std::uint64_t>(footer, 0);  // no summary
    Put<std::uint64_t>(footer, 0);
    Put<std::uint32_t>(footer, 0);
    Record(0x02, footer);
    return out_ + kMagic;
  }

 private:
  static inline const std::string kMagic{"\x89MCAP0\r\n"};

  template <typename Number>
  static void Put(std::string& out, Number number) {
    for (std::size_t i = 0; i < sizeof(Number); ++i) {
      out += static_cast<char>((number >> (8 * i)) & 0xFF);
    }
  }
  static void PutText(std::string& out, const std::string& text) {
    Put(out, static_cast<std::uint32_t>(text.size()));
    out += text;
  }
  void Record(char code, const std::string& content) {
    out_ += code;
    Put<std::uint64_t>(out_, content.size());
    out_ += content;
  }

  std::string out_;
  std::map<std::string, std::uint16_t> schemas_;
  std::vector<std::uint32_t> sequences_;  // of each channel
};

}  // namespace trackbed
