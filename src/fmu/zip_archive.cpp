#include "src/fmu/zip_archive.h"

#include <fmt/format.h>
#include <zip.h>

#include <memory>

#include "trackbed/core/error.h"

namespace trackbed::fmu {
namespace {

struct SourceDeleter {
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
struct ArchiveDeleter {
  void operator()(zip_t* archive) const { zip_discard(archive); }
};

[[noreturn]] void Fail(const char* message) {
  throw RunError(fmt::format("cannot make a ZIP archive: {}", message));
}

std::string ReadAll(zip_source_t& source) {
  zip_stat_t stat;
  zip_stat_init(&stat);
  if (zip_source_open(&source) < 0 || zip_source_stat(&source, &stat) < 0) {
    Fail(zip_error_strerror(zip_source_error(&source)));
  }
  std::string bytes(stat.size, '\0');
  const zip_int64_t read = zip_source_read(&source, bytes.data(), bytes.size());
  if (read != static_cast<zip_int64_t>(bytes.size())) {
    Fail(zip_error_strerror(zip_source_error(&source)));
  }
  zip_source_close(&source);
  return bytes;
}

}  // namespace

std::string MakeZip(const std::vector<ZipEntry>& entries, const std::string& comment) {
  zip_error_t error;
  zip_error_init(&error);
  const std::unique_ptr<zip_source_t, SourceDeleter> target(
      zip_source_buffer_create(nullptr, 0, 0, &error));
  if (target == nullptr) {
    Fail(zip_error_strerror(&error));
  }
  // Add a reference to the libzip source: closing the archive frees one reference, but the source
  // is read afterwards.
  zip_source_keep(target.get());
  std::unique_ptr<zip_t, ArchiveDeleter> archive(
      zip_open_from_source(target.get(), ZIP_TRUNCATE, &error));
  if (archive == nullptr) {
    zip_source_free(target.get());
    Fail(zip_error_strerror(&error));
  }
  for (const ZipEntry& entry : entries) {
    zip_source_t* content =
        zip_source_buffer(archive.get(), entry.content.data(), entry.content.size(), 0);
    const zip_int64_t index = content == nullptr ? -1
                                                 : zip_file_add(archive.get(), entry.name.c_str(),
                                                                content, ZIP_FL_ENC_UTF_8);
    if (index < 0) {
      zip_source_free(content);
      Fail(zip_strerror(archive.get()));
    }
    // Use a fixed file time, 1980-01-01, the earliest time in the ZIP format.
    const auto place = static_cast<zip_uint64_t>(index);
    if (zip_file_set_dostime(archive.get(), place, 0, (1U << 5U) | 1U, 0) < 0 ||
        zip_set_file_compression(archive.get(), place, ZIP_CM_DEFLATE, 1) < 0 ||
        zip_file_set_external_attributes(archive.get(), place, 0, ZIP_OPSYS_UNIX, 0100644U << 16U) <
            0) {
      Fail(zip_strerror(archive.get()));
    }
  }
  if (zip_set_archive_comment(archive.get(), comment.data(),
                              static_cast<zip_uint16_t>(comment.size())) < 0) {
    Fail(zip_strerror(archive.get()));
  }
  if (zip_close(archive.get()) < 0) {
    Fail(zip_strerror(archive.get()));
  }
  // Release the pointer, because zip_close has freed the archive.
  static_cast<void>(archive.release());
  return ReadAll(*target);
}

}  // namespace trackbed::fmu
