#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "trackbed/core/file.h"

namespace trackbed {

/// The finished rows of a study in a file that only grows, so that a study that was killed at any
/// moment goes on where it was. The first line says of what study, each further one is a row:
/// "CRC-32 JSON", the checksum of the JSON in eight hexadecimal digits.
///
/// A row is appended by one write. What a killed process, a full disk or a power failure left
/// behind the last whole line is cut off when the file is opened. Of several lines of one row the
/// last counts. Rows are forced to the disk at most once a second.
///
/// Memory: 8 bytes for each row that the study has.
class SweepRecords {
 public:
  /// Opens the file, or makes it. `header` is of the study as it is now; `rows_expected` in it is
  /// how many rows it has.
  ///
  /// InputError naming the file and the keys in which the study differs from the one whose rows it
  /// has; RunError when it cannot be read or written.
  SweepRecords(const std::filesystem::path& file, const nlohmann::ordered_json& header);
  /// Opens a file that is there, of any study, to be read only, also while a sweep writes to it.
  /// InputError when it has no header.
  explicit SweepRecords(const std::filesystem::path& file);
  /// In memory.
  static SweepRecords InMemory(nlohmann::ordered_json header);

  [[nodiscard]] const nlohmann::ordered_json& header() const { return header_; }
  [[nodiscard]] std::size_t rows() const { return offsets_.size(); }
  [[nodiscard]] bool Has(std::size_t row) const { return offsets_[row] >= 0; }
  /// How many rows there are, of all.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Several threads may append at a time. RunError on a full disk: the file then has the rows
  /// before, and no part of this one.
  void Append(std::size_t row, const nlohmann::ordered_json& content);

  /// A row that there is.
  [[nodiscard]] nlohmann::ordered_json Read(std::size_t row) const;

 private:
  SweepRecords(std::filesystem::path file, int descriptor);
  /// Reads the file; a header, if there is one, must be this one.
  void Load(const std::optional<nlohmann::ordered_json>& header);
  void TakeHeader(nlohmann::ordered_json header);
  void WriteLine(std::string_view json);
  [[noreturn]] void Fail(const char* what, int error) const;

  std::filesystem::path file_;
  Descriptor descriptor_;
  nlohmann::ordered_json header_;
  std::vector<std::int64_t> offsets_;  // of the lines; -1: none
  std::size_t count_ = 0;
  std::int64_t end_ = 0;                                                // of the file, in bytes
  std::int64_t synced_ = 0;                                             // when, in seconds
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // of appending
};

/// The paths at which two values differ, "vary.world.friction: [0.3] was [0.5]", at most five.
std::vector<std::string> Differences(const nlohmann::ordered_json& now,
                                     const nlohmann::ordered_json& before);

}  // namespace trackbed
