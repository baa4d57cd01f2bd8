#include "game/session/file_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "game/session/database.hpp"

namespace bolt::session {

namespace {

constexpr int max_attempts = 100;

std::string reason_of(int number) { return std::generic_category().message(number); }

// Whether `path` names the open file.
bool is_at(int handle, const std::filesystem::path& path) {
    struct stat open {};
    struct stat named {};
    return ::fstat(handle, &open) == 0 && ::lstat(path.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
           open.st_ino == named.st_ino;
}

// A file with content is not a lock, so it is never removed.
bool is_empty_file(int handle) {
    struct stat open {};
    return ::fstat(handle, &open) == 0 && S_ISREG(open.st_mode) && open.st_size == 0;
}

}  // namespace

Result<FileLock> FileLock::take(const std::filesystem::path& path, const std::string& file) {
    constexpr const char* taken = "another program is recording into this file";
    const std::filesystem::path place = path.string() + ".lock";
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        FileLock lock(::open(place.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
        if (lock.handle_ < 0) {
            const int reason = errno;
            struct stat there {};
            if (::lstat(place.c_str(), &there) == 0)
                return file_error(
                    file, fmt::format("its lock {} cannot be opened: {}", place.string(), reason_of(reason)));
            return file_error(file, "nothing can be written in its folder: " + reason_of(reason));
        }
        if (::flock(lock.handle_, LOCK_EX | LOCK_NB) != 0) {
            if (errno == EWOULDBLOCK) return file_error(file, taken);
            if (errno == EINTR) continue;
            return file_error(file, "cannot be locked: " + reason_of(errno));
        }
        // Its holder may have removed it since it was opened; a removed file locks nothing.
        if (!is_at(lock.handle_, place)) continue;
        if (!is_empty_file(lock.handle_))
            return file_error(
                file, fmt::format("{} is not a lock file; expected an empty file or none", place.string()));
        lock.held_ = place;
        return lock;
    }
    return file_error(file, taken);
}

FileLock::FileLock(FileLock&& other) noexcept
    : handle_(std::exchange(other.handle_, -1)), held_(std::move(other.held_)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(held_, other.held_);
    return *this;
}

FileLock::~FileLock() {
    if (handle_ < 0) return;
    // Remove the name before the lock is released, so that no other program has acquired it in between.
    if (!held_.empty() && is_at(handle_, held_)) (void)::unlink(held_.c_str());
    (void)::close(handle_);
}

}  // namespace bolt::session
