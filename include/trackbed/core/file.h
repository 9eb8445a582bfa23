#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trackbed {

/// The default limit on the size of a file that is read [bytes]: an hour of a run at 100 rows a
/// second takes half of it.
inline constexpr std::size_t kMaxFileBytes = std::size_t{512} << 20U;

/// Reads a whole file as bytes. RunError naming the file when it is missing or not a regular file
/// (OpenInput), or has more than `max_bytes` bytes; it then reads no more than these.
std::string ReadFile(const std::filesystem::path& file, std::size_t max_bytes = kMaxFileBytes);

/// Reads a file as a stream: calls `take` with one block of at most 64 KiB after the other, until
/// it returns false. RunError as ReadFile.
void ReadBlocks(const std::filesystem::path& file,
                const std::function<bool(std::string_view block)>& take,
                std::size_t max_bytes = kMaxFileBytes);

/// Writes `content` beside `file` under a temporary name and renames it, so that `file` is either
/// unchanged or complete, even if the process is killed. RunError (the temporary file is removed)
/// when any step fails, for example on a full disk or an unwritable folder. The content is not
/// forced to the disk (fsync), which would take up to tens of milliseconds per file: after a power
/// failure a file may be empty, which the hashes of manifest.json (analysis/output_folder.h)
/// reveal.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

/// Checks, before long work, that WriteFileAtomically can write the file. RunError if the name is a
/// folder's, or its folder is missing or unwritable. Leaves nothing behind.
void CheckCanWrite(const std::filesystem::path& file);

/// Creates the folder and its parents. RunError when that is not possible.
void MakeFolder(const std::filesystem::path& folder);

class Descriptor;

/// Opens an input file; every reader uses this. RunError naming the file when it is missing or not
/// a regular file: a pipe or a device may block or never end, and many inputs are read twice.
Descriptor OpenInput(const std::filesystem::path& file);

/// A file descriptor that is closed by its destructor.
class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  [[nodiscard]] int get() const { return descriptor_; }
  /// Returns 0 or an errno: a full disk may be reported only on closing.
  int Close();

 private:
  int descriptor_;
};

/// A file that does not exist yet, in a folder that nobody else uses. Errors are RunErrors naming
/// `shown`, the later name of the file; an incomplete file may remain.
class NewFile {
 public:
  NewFile(const std::filesystem::path& file, std::filesystem::path shown);
  /// Appends to the file.
  void Write(std::string_view content);
  /// Closes the file. Call it last: a full disk may be reported only on closing.
  void Close();

 private:
  std::filesystem::path shown_;
  Descriptor descriptor_;
};

/// Writes a whole NewFile.
void WriteNewFile(const std::filesystem::path& file, std::string_view content,
                  const std::filesystem::path& shown);

/// A new, empty file beside `file`, for use until the content is complete: ".STEM.PID-N.trackbed",
/// with the extension of `file`, for writers that depend on it. Its lock (flock) distinguishes it
/// from the leftover of a killed process. The destructor removes the file.
class TemporaryFile {
 public:
  /// RunError naming `file` when its folder is missing or unwritable.
  explicit TemporaryFile(std::filesystem::path file);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Appends to the file. RunError naming `file`.
  void Write(std::string_view content);
  /// Renames the complete file to `file`, or to the target of a link of that name. RunError on
  /// failure, and when the name belongs to something that is not a regular file. Call once.
  void Publish();

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// A new, empty folder beside `file` for its parts; named, locked and removed like a TemporaryFile.
class TemporaryFolder {
 public:
  /// RunError naming `file` when its folder is missing or unwritable.
  explicit TemporaryFolder(const std::filesystem::path& file);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Removes the TemporaryFiles and TemporaryFolders of killed processes from the folder; keeps those
/// of running processes, and all of them where files cannot be locked. Never fails.
void RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// Prepares for long work that ends with writing `file`: makes its folder, removes the leftovers of
/// killed processes there, and checks that the file can be written. RunError as MakeFolder and
/// CheckCanWrite.
void PrepareToWrite(const std::filesystem::path& file);

/// Why an input file in the folder `own` may not refer to the file `name`, given relative to `own`,
/// as the end of a sentence ("lies outside of ..."). Empty if it may: after following links, the
/// file lies in or below `own` or one of `others`. An absolute name must lie in one of `others`.
std::string ReadAccessError(const std::filesystem::path& name, const std::filesystem::path& own,
                            const std::vector<std::filesystem::path>& others);

}  // namespace trackbed
