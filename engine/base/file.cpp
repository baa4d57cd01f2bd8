#include "engine/base/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <system_error>

namespace bolt {

namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

constexpr const char* readable_file = "a file that this user may read";
constexpr const char* writable_path = "a path that this user may write to, and free space";

tl::unexpected<Error> file_error(const std::filesystem::path& path, ErrorCode code, std::string what,
                                 std::string expected) {
    Error error;
    error.code = code;
    error.file = path.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, ErrorCode code) {
    std::error_code status;
    if (std::filesystem::is_directory(path, status)) return file_error(path, code, "is a folder", "a file");
    const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
    if (!file)
        return file_error(path, code, std::string("cannot be opened: ") + std::strerror(errno),
                          readable_file);
    std::string text;
    char block[65536];
    std::size_t count = 0;
    while ((count = std::fread(block, 1, sizeof block, file.get())) > 0) {
        text.append(block, count);
        const bool in_mib = limit >= std::size_t{1} << 20U;
        if (text.size() > limit)
            return file_error(path, code,
                              "is larger than " + std::to_string(limit >> (in_mib ? 20U : 10U)) +
                                  (in_mib ? " MiB" : " KiB"),
                              "a smaller file");
    }
    if (std::ferror(file.get()) != 0) return file_error(path, code, "cannot be read", readable_file);
    return text;
}

Status write_file(const std::filesystem::path& path, std::string_view text) {
    std::error_code status;
    const std::filesystem::file_status target = std::filesystem::status(path, status);
    const bool not_regular = std::filesystem::exists(target) && !std::filesystem::is_regular_file(target);
    std::filesystem::path part = path;
    if (!not_regular) part += ".part";  // a device or a pipe is written to, never replaced
    std::FILE* file = std::fopen(part.c_str(), "wb");
    if (file == nullptr)
        return file_error(path, ErrorCode::failed, std::string("cannot be written: ") + std::strerror(errno),
                          writable_path);
    const bool written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    const int write_errno = errno;
    const bool closed = std::fclose(file) == 0;
    if (!written || !closed) {
        const int reason = written ? errno : write_errno;
        if (!not_regular) (void)std::remove(part.c_str());
        return file_error(path, ErrorCode::failed, std::string("cannot be written: ") + std::strerror(reason),
                          writable_path);
    }
    if (not_regular) return {};
    std::filesystem::rename(part, path, status);
    if (!status) return {};
    (void)std::remove(part.c_str());
    return file_error(path, ErrorCode::failed, "cannot be written: " + status.message(), writable_path);
}

namespace {

// Writes the text to an open file and waits until it is on the disk. Returns the errno of a failure, else 0.
int write_to_disk(int file, std::string_view text) {
    while (!text.empty()) {
        const ::ssize_t written = ::write(file, text.data(), text.size());
        if (written < 0 && errno != EINTR) return errno;
        if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
    }
    return ::fsync(file) == 0 ? 0 : errno;
}

// Makes a rename in the folder permanent. File systems without this operation are ignored.
void sync_folder(const std::filesystem::path& folder) {
    const int handle = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle < 0) return;
    (void)::fsync(handle);
    (void)::close(handle);
}

}  // namespace

Status write_private_file(const std::filesystem::path& path, std::string_view text) {
    const auto failed = [&](int reason) {
        return file_error(path, ErrorCode::failed, std::string("cannot be written: ") + std::strerror(reason),
                          writable_path);
    };
    std::filesystem::path part = path;
    part += ".part";
    (void)::unlink(part.c_str());  // one that a killed program left may have other permissions
    const int file = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return failed(errno);
    int reason = write_to_disk(file, text);
    if (::close(file) != 0 && reason == 0) reason = errno;
    if (reason == 0 && ::rename(part.c_str(), path.c_str()) != 0) reason = errno;
    if (reason != 0) {
        (void)::unlink(part.c_str());
        return failed(reason);
    }
    sync_folder(path.parent_path());
    return {};
}

Status require_different_files(const std::filesystem::path& input, const std::filesystem::path& output) {
    std::error_code none;
    if (!std::filesystem::equivalent(input, output, none) || none) return {};
    return fail(ErrorCode::usage, output.string() + " is also the input", "a different output file");
}

Result<std::filesystem::path> user_data_folder() {
    // NOLINTBEGIN(concurrency-mt-unsafe): nothing sets them
    if (const char* data = std::getenv("XDG_DATA_HOME");
        data != nullptr && std::filesystem::path(data).is_absolute())
        return std::filesystem::path(data) / "boltwright";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return std::filesystem::path(home) / ".local" / "share" / "boltwright";
    // NOLINTEND(concurrency-mt-unsafe)
    return fail(ErrorCode::usage, "there is no home folder for user data",
                "the environment variable HOME, or an explicit folder");
}

FileStamp stamp(const std::filesystem::path& file) {
    // std::filesystem does not provide the inode. Only the inode reveals that a file of the same size was
    // renamed over this one.
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return {};
    return {std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec,
            static_cast<std::uint64_t>(status.st_size), status.st_ino, true};
}

void FileWatch::watch(std::vector<std::filesystem::path> files) {
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    std::vector<Watched> watched;
    for (const std::filesystem::path& file : files) {
        const auto known = std::find_if(files_.begin(), files_.end(),
                                        [&](const Watched& entry) { return entry.file == file; });
        if (known != files_.end()) {
            watched.push_back(std::move(*known));
        } else {
            const FileStamp now = stamp(file);
            watched.push_back({file, now, now, {}});
        }
    }
    files_ = std::move(watched);
}

std::vector<std::filesystem::path> FileWatch::changed(double now) {
    std::vector<std::filesystem::path> files;
    for (Watched& entry : files_) {
        const FileStamp current = stamp(entry.file);
        if (!entry.since || current != entry.latest) entry.since = now;
        entry.latest = current;
        if (current == entry.reported) {
            entry.since.reset();
        } else if (now - *entry.since >= settle_time_) {
            entry.reported = current;
            entry.since.reset();
            files.push_back(entry.file);
        }
    }
    return files;
}

}  // namespace bolt
