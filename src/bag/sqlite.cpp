#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <memory>

#include "src/bag/decompress.h"
#include "src/bag/sources.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Reads SQLite files of rosbag2: the table `topics` describes the topics, and the table `messages`
// contains the messages. SQLite bags since ROS 2 Iron also have the table `message_definitions`.
// Each message may be compressed separately by zstd.
namespace trackbed {
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

[[noreturn]] void RefuseSqlite(const std::filesystem::path& file, sqlite3* database) {
  RefuseBag(file, fmt::format("no SQLite bag, or damaged: {}", sqlite3_errmsg(database)));
}

/// Opens an untrusted file: SQLite may neither write the file nor run functions of the file's
/// schema.
Database Open(const std::filesystem::path& file) {
  static_cast<void>(OpenInput(file));  // refuses pipes and devices
  sqlite3* opened = nullptr;
  const int code = sqlite3_open_v2(file.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
  Database database(opened, sqlite3_close);
  if (code != SQLITE_OK) {
    RefuseSqlite(file, opened);
  }
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxChunkBytes));
  sqlite3_exec(opened, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=0;", nullptr, nullptr, nullptr);
  return database;
}

Statement Prepare(sqlite3* database, const char* query, const std::filesystem::path& file) {
  sqlite3_stmt* prepared = nullptr;
  if (sqlite3_prepare_v2(database, query, -1, &prepared, nullptr) != SQLITE_OK) {
    RefuseSqlite(file, database);
  }
  return Statement(prepared, sqlite3_finalize);
}

bool Next(sqlite3* database, const Statement& statement, const std::filesystem::path& file) {
  const int code = sqlite3_step(statement.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) {
    RefuseSqlite(file, database);
  }
  return code == SQLITE_ROW;
}

std::string_view Blob(const Statement& statement, int column) {
  const void* data = sqlite3_column_blob(statement.get(), column);
  const int size = sqlite3_column_bytes(statement.get(), column);
  return data == nullptr
             ? std::string_view()
             : std::string_view(static_cast<const char*>(data), static_cast<std::size_t>(size));
}

std::string Text(const Statement& statement, int column) {
  return std::string(Blob(statement, column));
}

/// Returns the message definitions of a SQLite bag in the format ros2msg; empty for bags before ROS
/// 2 Iron.
std::map<std::string, std::string> Definitions(sqlite3* database,
                                               const std::filesystem::path& file) {
  std::map<std::string, std::string> definitions;
  const Statement exists = Prepare(
      database, "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'message_definitions'",
      file);
  if (!Next(database, exists, file)) {
    return definitions;
  }
  const Statement rows = Prepare(
      database, "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions",
      file);
  while (definitions.size() < kMaxBagTopics && Next(database, rows, file)) {
    if (Text(rows, 1) == "ros2msg") {
      definitions[Text(rows, 0)] = Text(rows, 2);
    }
  }
  return definitions;
}

void ReadMessages(sqlite3* database, std::int64_t id, const BagTopic& topic,
                  const std::filesystem::path& file, const TakeTopicMessage& take) {
  const Statement rows = Prepare(
      database, "SELECT data, timestamp FROM messages WHERE topic_id = ? ORDER BY timestamp, id",
      file);
  sqlite3_bind_int64(rows.get(), 1, id);
  while (Next(database, rows, file)) {
    const std::string_view data = Blob(rows, 0);
    const std::int64_t time = sqlite3_column_int64(rows.get(), 1);
    // CDR messages begin with a zero byte, so a message that begins with the four magic bytes of
    // zstd is compressed.
    if (data.starts_with("\x28\xB5\x2F\xFD")) {
      take(topic, Decompress(data, "zstd", kMaxChunkBytes, file), time);
    } else {
      take(topic, data, time);
    }
  }
}

}  // namespace

void ReadSqlite(const std::filesystem::path& file, BagContent& content, const std::string& wanted,
                const TakeTopicMessage& take) {
  const Database database = Open(file);
  const std::map<std::string, std::string> definitions = Definitions(database.get(), file);
  std::map<std::int64_t, std::string> names;
  const Statement rows =
      Prepare(database.get(), "SELECT id, name, type, serialization_format FROM topics", file);
  while (Next(database.get(), rows, file)) {
    BagTopic topic{
        .name = Text(rows, 1), .type = Text(rows, 2), .encoding = Text(rows, 3), .definition = {}};
    const auto definition = definitions.find(topic.type);
    topic.definition = definition == definitions.end() ? "" : definition->second;
    static_cast<void>(TopicOf(content, topic, file));
    names[sqlite3_column_int64(rows.get(), 0)] = topic.name;
  }
  const Statement counts =
      Prepare(database.get(), "SELECT topic_id, count(*) FROM messages GROUP BY topic_id", file);
  while (Next(database.get(), counts, file)) {
    const auto name = names.find(sqlite3_column_int64(counts.get(), 0));
    if (name != names.end()) {
      TopicOf(content, {.name = name->second}, file).messages +=
          static_cast<std::size_t>(sqlite3_column_int64(counts.get(), 1));
    }
  }
  for (const auto& [id, name] : names) {
    if (take && name == wanted) {
      ReadMessages(database.get(), id, TopicOf(content, {.name = name}, file), file, take);
    }
  }
}

}  // namespace trackbed
