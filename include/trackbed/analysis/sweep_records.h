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
/// any moment can resume. The first line of the file identifies the study. Each further line is one
/// row: the CRC-32 of the JSON as eight hexadecimal digits, a space, and the JSON.
///
/// Each row is appended by a single write. An incomplete last line, left by a killed process, a
/// full disk or a power failure, is cut off when the file is opened. If several lines contain the
/// same row, the last of these lines applies. Rows are synchronized to the disk at most once a
/// second.
///
/// Memory: 8 bytes for each row of the study.
class SweepRecords {
 public:
  /// Opens the file, or creates it at once with its header. `header` describes the current study,
  /// including its number of rows `rows_expected`.
  ///
  /// If the file belongs to another study, InputError naming the file, the differing keys and the
  /// `remedy`. RunError if the file cannot be read or written.
  SweepRecords(const std::filesystem::path& file, const nlohmann::ordered_json& header,
               std::string_view remedy = "--restart removes them, another folder (-o) keeps them");
  /// Opens an existing file of any study for reading only, even while a sweep writes to it.
  /// InputError if the file has no header.
  explicit SweepRecords(const std::filesystem::path& file);
  /// Whether the file is a regular file that begins with a header written by SweepRecords.
  static bool IsFileOfRecords(const std::filesystem::path& file);
  /// Removes the file if it exists. RunError if the file is a link, a folder, or does not contain
  /// records (IsFileOfRecords).
  static void Remove(const std::filesystem::path& file);
  /// Makes records that are kept in memory, without a file.
  static SweepRecords InMemory(nlohmann::ordered_json header);

  /// The unchecked header, to be used only for copying and comparing.
  [[nodiscard]] const nlohmann::ordered_json& header() const { return header_->json(); }
  /// The header, for reading its values. The getters throw the InputErrors of JsonValue.
  [[nodiscard]] const JsonValue& Header() const { return *header_; }
  /// The columns of the table, including `status`. InputError if the header has no columns.
  [[nodiscard]] const std::vector<std::string>& Columns() const;
  [[nodiscard]] std::size_t rows() const { return offsets_.size(); }
  [[nodiscard]] bool Has(std::size_t row) const { return offsets_[row] >= 0; }
  /// Number of rows that are present.
  [[nodiscard]] std::size_t count() const { return count_; }

  /// Appends a row. Several threads may append at the same time. RunError if the disk is full; the
  /// file then contains the earlier rows and no part of the new row.
  void Append(std::size_t row, const nlohmann::ordered_json& content);

  /// Reads a row, which must be present. Use the result only to copy or compare. InputError if the
  /// row is not JSON.
  [[nodiscard]] nlohmann::ordered_json Read(std::size_t row) const;
  /// Reads a row, which must be present. Throws the InputErrors of JsonValue and Read.
  [[nodiscard]] JsonValue Entry(std::size_t row) const;

 private:
  SweepRecords(std::filesystem::path file, int descriptor);
  /// Reads the file. If `header` is given, the file's header must equal it.
  void Load(const std::optional<nlohmann::ordered_json>& header, std::string_view remedy = "");
  void TakeHeader(nlohmann::ordered_json header);
  void WriteLine(std::string_view json);
  [[noreturn]] void Fail(const char* what, int error) const;

  std::filesystem::path file_;
  Descriptor descriptor_;
  std::optional<JsonValue> header_;  // Header; every constructor sets it.
  std::vector<std::string> columns_;
  std::vector<std::int64_t> offsets_;  // Offsets of the lines in the file; -1: row missing.
  std::size_t count_ = 0;
  std::int64_t end_ = 0;     // Size of the file in bytes.
  std::int64_t synced_ = 0;  // Time of the last sync, in seconds.
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();  // Guards appending.
};

/// Lists the paths at which two values differ, at most five: "vary.world.friction: [0.3] was
/// [0.5]".
std::vector<std::string> Differences(const nlohmann::ordered_json& now,
                                     const nlohmann::ordered_json& before);

}  // namespace trackbed
