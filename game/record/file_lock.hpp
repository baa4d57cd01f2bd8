// One recording at a time into a file, among all programs of this machine.
#pragma once

#include <filesystem>
#include <string>

#include "engine/base/result.hpp"

namespace bolt::record {

// Held from take() on; lost with the process, however it ends. An empty file beside `path`, with ".lock"
// behind its name, is locked: what a killed process leaves of it is in nobody's way, otherwise it goes with
// the lock.
class FileLock {
  public:
    // At once or not at all. `file` is what errors call the file; they give the system's own reason.
    static Result<FileLock> take(const std::filesystem::path& path, const std::string& file);
    FileLock(FileLock&& other) noexcept;
    FileLock& operator=(FileLock&& other) noexcept;
    ~FileLock();

  private:
    explicit FileLock(int handle) : handle_(handle) {}

    int handle_;
    std::filesystem::path held_;  // empty: open, but not locked
};

}  // namespace bolt::record
