// Lets one program of this machine at a time record into a file.
#pragma once

#include <filesystem>
#include <string>

#include "engine/base/result.hpp"

namespace bolt::session {

// Held from take() until destruction or the end of the process. It locks an empty file beside `path`, named
// with an additional ".lock". That file is removed with the lock; one that a killed process leaves does no
// harm.
class FileLock {
  public:
    // Does not wait. `file` names the file in errors, which give the system's reason.
    static Result<FileLock> take(const std::filesystem::path& path, const std::string& file);
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;
    ~FileLock();

  private:
    explicit FileLock(int handle) : handle_(handle) {}

    int handle_;
    std::filesystem::path held_;  // empty: open, but not locked
};

}  // namespace bolt::session
