#pragma once

#include <sys/types.h>

#include <filesystem>

#include "trackbed/core/file.h"

namespace trackbed {

/// Throws RunError with a message "cannot WHAT FILE: REASON", where REASON describes the errno
/// value `error`.
[[noreturn]] void FailOnFile(const char* what, const std::filesystem::path& file, int error);

/// Returns a description of a special file for error messages, for example "a pipe" or "a device".
const char* KindOfFile(mode_t mode);

/// Returns whether the file is a device or pipe (/dev/stdout, /dev/full), which can be written but
/// not replaced.
bool IsDevice(const std::filesystem::path& file);

/// Throws RunError if the file is a link whose target is absent. Renaming a new file to the link's
/// name would replace the link, and creating the absent target could write anywhere.
void RequireTarget(const std::filesystem::path& file);

/// Throws RunError if a temporary file cannot replace the file, which may be a folder, a device, a
/// pipe, or a link whose target is absent.
void RequireReplaceable(const std::filesystem::path& file);

/// Opens a device or a pipe for writing. Throws RunError if no process opens the pipe for reading
/// within one second.
Descriptor OpenDevice(const std::filesystem::path& file);

}  // namespace trackbed
