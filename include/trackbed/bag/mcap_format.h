#pragma once

#include <string_view>

/// Constants of the MCAP format (https://mcap.dev/spec), for the reader of bags and the writer of
/// logs.
namespace trackbed::mcap {

/// Magic bytes at the beginning and at the end of an MCAP file.
inline constexpr std::string_view kMagic = "\x89MCAP0\r\n";

/// First byte of an MCAP record, which identifies the kind of the record.
enum Opcode : unsigned char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

}  // namespace trackbed::mcap
