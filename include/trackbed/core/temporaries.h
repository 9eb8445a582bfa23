#pragma once

#include <filesystem>
#include <functional>

/// The list of the temporary files and folders of this process (TemporaryFile and TemporaryFolder
/// in file.h). When a signal ends the process, the destructors of TemporaryFile and TemporaryFolder
/// do not run. When a signal ends the process, RemoveTemporariesForEver removes the files and
/// folders in the list.
namespace trackbed {

/// Adds `path` to the list of temporary files and calls `create`. If `create` returns false,
/// removes `path` from the list. Returns the result of `create`, and leaves `errno` as `create` set
/// it.
bool AddTemporary(const std::filesystem::path& path, const std::function<bool()>& create);

/// Calls `remove`, which removes or renames `path`. If `remove` returns true, removes `path` from
/// the list of temporary files. Returns the result of the function `remove`.
bool DropTemporary(const std::filesystem::path& path, const std::function<bool()>& remove);

/// Removes all temporary files and folders of this process. Call RemoveTemporariesForEver right
/// before _exit(): after the call, threads that create, publish or remove a temporary file wait for
/// ever. RemoveTemporariesForEver takes a lock, so a signal handler must not call it. Never throws.
void RemoveTemporariesForEver() noexcept;

}  // namespace trackbed
