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

#include "trackbed/analysis/json_file.h"
#include "trackbed/core/file.h"

namespace trackbed {

/// Stores the finished rows of a study in an append-only file, so that a study that was killed at
/// any moment can resume. The first line of the records identifies the study. Each further line of
/// the records is one row of the study. A line of a row consists of the CRC-32 checksum of the
/// row's JSON text as eight hexadecimal digits, a space, and the JSON text.
///
/// Each row is appended by a single write operation. When the file is opened, an incomplete last
/// line, left by a killed process, a full disk or a power failure, is removed. If several lines
/// contain the same row, only the last of these lines is used. Appended rows are synchronized to
/// the disk at most once a second.
///
/// Memory: 8 bytes for each row of the study.
class SweepRecords {
 public:
  /// Opens the file of records; if the file does not exist, creates the file with the given header.
  /// `header` describes the current study and contains its number of rows, `rows_expected`.
  ///
  /// Throws InputError, naming the file, the differing keys and the `remedy`, if the file belongs
  /// to another study. Throws RunError if the file cannot be read or written.
  SweepRecords(const std::filesystem::path& file, const nlohmann::ordered_json& header,
               std::string_view remedy = "--restart removes them, another folder (-o) keeps them");
  /// Opens an existing file of any study for reading only; another process may be writing to the
  /// file. Throws InputError if the file has no header.
  explicit SweepRecords(const std::filesystem::path& file);
  /// Whether the file is a regular file that begins with a header written by SweepRecords.
  static bool IsFileOfRecords(const std::filesystem::path& file);
  /// Removes the file of records if the file exists. Throws RunError if the file is a link, a
  /// folder, or does not contain records (IsFileOfRecords).
  static void Remove(const std::filesystem::path& file);
  /// Makes records that are kept in memory, without a file.
  static SweepRecords InMemory(nlohmann::ordered_json header);

  /// Returns the header of the records as unchecked JSON, to be used only for copying and
  /// comparing.
  [[nodiscard]] const nlohmann::ordered_json& header() const { return header_->json(); }
  /// Returns the header of the records as a JsonValue, to read values with checks. The getters of
  /// JsonValue throw InputError if a value is not as expected.
  [[nodiscard]] const JsonValue& Header() const { return *header_; }
  /// Returns the names of the columns of the study's table, including `status`. Throws InputError
  /// if the header has no columns.
  [[nodiscard]] const std::vector<std::string>& Columns() const;
  [[nodiscard]] std::size_t rows() const { return offsets_.size(); }
  [[nodiscard]] bool Has(std::size_t row) const { return offsets_[row] >= 0; }
  /// Returns the number of rows that the records contain.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Appends a row. Several threads may append rows at the same time. Throws RunError if the disk
  /// is full; the file then contains the earlier rows and no part of the new row.
  void Append(std::size_t row, const nlohmann::ordered_json& content);

  /// Reads a row of the study, which the records must contain. The JSON of the returned row is not
  /// checked, and should only be copied or compared. Throws InputError if the row is not JSON.
  [[nodiscard]] nlohmann::ordered_json Read(std::size_t row) const;
  /// Reads a row of the study, which the records must contain. Returns the row as a JsonValue,
  /// whose getters check the values. Throws InputError if Read throws InputError.
  [[nodiscard]] JsonValue Entry(std::size_t row) const;

 private:
  SweepRecords(std::filesystem::path file, int descriptor);
  /// Reads the file of records. If `header` is given, the header in the file must equal `header`.
  void Load(const std::optional<nlohmann::ordered_json>& header, std::string_view remedy = "");
  void TakeHeader(nlohmann::ordered_json header);
  void WriteLine(std::string_view json);
  [[noreturn]] void Fail(const char* what, int error) const;

  std::filesystem::path file_;
  Descriptor descriptor_;
  std::optional<JsonValue> header_;  // Header of the records, which every constructor sets.
  std::vector<std::string> columns_;
  std::vector<std::int64_t> offsets_;  // Offset of each row's line in the file; -1: row missing.
  std::size_t count_ = 0;
  std::int64_t end_ = 0;     // Size of the file in bytes.
  std::int64_t synced_ = 0;  // Time of the last synchronization to the disk, in seconds.
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // Guards appending.
};

/// Lists at most five paths at which two JSON values differ, with texts such as
/// "vary.world.friction: [0.3] was [0.5]".
std::vector<std::string> Differences(const nlohmann::ordered_json& now,
                                     const nlohmann::ordered_json& before);

}  // namespace trackbed
