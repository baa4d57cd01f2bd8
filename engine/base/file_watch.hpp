// Files that change on disk, seen by looking at them now and then: that works on every file system, and with
// editors that write a new file and rename it over the old one. A change is told when the file has been left
// alone for a while, so that half-written files are not read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace bolt {

// What tells two versions of a file apart without reading them. A file that is not there is a version too.
struct FileStamp {
    std::int64_t modified = 0;  // ns
    std::uint64_t size = 0, inode = 0;
    bool there = false;
    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
FileStamp stamp(const std::filesystem::path& file);

class FileWatch {
  public:
    explicit FileWatch(double quiet = 0.15) : quiet_(quiet) {}  // s

    // From now on these and no others. Files that were watched before keep what was known of them.
    void watch(std::vector<std::filesystem::path> files);

    // Those that have changed since they were told last, or since they are watched. `now` in seconds, of any
    // clock that never goes back.
    std::vector<std::filesystem::path> changed(double now);

  private:
    struct Watched {
        std::filesystem::path file;
        FileStamp told, seen;
        std::optional<double> since;  // when `seen` was first seen, if it is not what was told
    };
    double quiet_;
    std::vector<Watched> files_;
};

}  // namespace bolt
