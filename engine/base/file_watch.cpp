#include "engine/base/file_watch.hpp"

#include <sys/stat.h>

#include <algorithm>

namespace bolt {

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
