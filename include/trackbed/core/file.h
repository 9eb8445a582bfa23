#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trackbed {

/// The most bytes that are read of a file unless a reader asks for fewer: an hour of a run at 100
/// rows a second takes half of it.
inline constexpr std::size_t kLargestFile = std::size_t{512} << 20U;

/// The whole file as bytes. RunError naming the file when it cannot be read (missing, a folder, …)
/// or has more than `largest` bytes, of which no more are read then.
std::string ReadFile(const std::filesystem::path& file, std::size_t largest = kLargestFile);

/// The file as a stream: calls `take` with one block of at most 64 KiB after the other, until it
/// gives back false. RunError as ReadFile.
void ReadBlocks(const std::filesystem::path& file,
                const std::function<bool(std::string_view block)>& take,
                std::size_t largest = kLargestFile);

/// Writes `content` beside `file` under a temporary name and renames it, so that `file` is either
/// what it was or complete, also when the process is killed. RunError (the temporary is removed)
/// when any step fails, such as a full disk or an unwritable folder. The content is not forced to
/// the disk (fsync), which takes up to tens of milliseconds per file: after a power failure a file
/// may be empty, which the hashes of manifest.json (analysis/output_folder.h) tell.
void WriteFileAtomically(const std::filesystem::path& file, std::string_view content);

/// Checks, before long work, that WriteFileAtomically can write the file. RunError as there: the
/// name is a folder's, or its folder is absent or takes no files. Leaves nothing behind.
void CheckCanWrite(const std::filesystem::path& file);

/// Creates the folder and its parents. RunError when that is not possible.
void MakeFolder(const std::filesystem::path& folder);

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int descriptor = -1) : descriptor_(descriptor) {}
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  [[nodiscard]] int get() const { return descriptor_; }
  /// Returns 0 or an errno: only closing tells whether everything found room.
  int Close();

 private:
  int descriptor_;
};

/// A file that is not there yet, in a folder that no one reads. Errors are RunErrors naming
/// `shown`, what the file will be called; what was written may be left.
class NewFile {
 public:
  NewFile(const std::filesystem::path& file, std::filesystem::path shown);
  /// Writes to its end.
  void Write(std::string_view content);
  /// Call last: only closing tells whether everything found room.
  void Close();

 private:
  std::filesystem::path shown_;
  Descriptor descriptor_;
};

/// Writes a NewFile at once.
void WriteNewFile(const std::filesystem::path& file, std::string_view content,
                  const std::filesystem::path& shown);

/// A new, empty file beside `file`, for use until the content is complete: ".STEM.PID-N.trackbed",
/// with the extension of `file`, for writers that depend on it. It is locked (flock) as long as the
/// object lives, which tells it from one that a killed process left, and removed with it.
class TemporaryFile {
 public:
  /// RunError naming `file` when its folder is absent or takes no files.
  explicit TemporaryFile(std::filesystem::path file);
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Writes to its end. RunError naming `file`.
  void Write(std::string_view content);
  /// Renames it, complete, to `file`, or to what a link of that name points to. RunError on
  /// failure, and when the name is taken by something that is no regular file. Call once.
  void Publish();

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// A new, empty folder beside `file` for its parts, named, locked and removed like a TemporaryFile.
class TemporaryFolder {
 public:
  /// RunError naming `file` when its folder is absent or takes no folders.
  explicit TemporaryFolder(const std::filesystem::path& file);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  Descriptor descriptor_;
};

/// Removes the TemporaryFiles and TemporaryFolders that killed processes left in the folder; those
/// of living ones stay. Where files cannot be locked all stay. No errors.
void RemoveAbandonedTemporaries(const std::filesystem::path& folder);

/// For a file that long work ends with: makes its folder, removes what killed processes left there,
/// and checks that it can be written. RunError as MakeFolder and CheckCanWrite.
void PrepareToWrite(const std::filesystem::path& file);

/// Why an input that lies in `own` may not have the file `name` read, which is relative to `own`,
/// as the end of a sentence ("lies outside of ..."); empty when it may: it lies in `own`, in one of
/// `others` or below, wherever links lead. An absolute name must lie in one of `others`.
std::string WhyUnreadable(const std::filesystem::path& name, const std::filesystem::path& own,
                          const std::vector<std::filesystem::path>& others);

}  // namespace trackbed
