// Reads and writes small files as a whole, finds the user's folder, and detects changes of files. Errors name
// the file and the reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

// Reads a whole file. Fails if it is missing, a folder, or larger than `limit` bytes, with the error `code`.
Result<std::string> read_file(const std::filesystem::path& path, std::size_t limit, ErrorCode code);

// Writes to a temporary file beside the target and renames it, so that a full disk never leaves a truncated
// file under that name. After an error the temporary file is removed. If `path` is a device or a pipe, the
// text is written to it directly.
Status write_file(const std::filesystem::path& path, std::string_view text);

// As write_file, for personal data: only the user may read the file, and it is on the disk when this returns.
// `path` must not be a device or a pipe.
Status write_private_file(const std::filesystem::path& path, std::string_view text);

// Fails if both paths name the same file, because writing the output would destroy the input.
Status require_different_files(const std::filesystem::path& input, const std::filesystem::path& output);

// Returns the folder of this program for the user's data: $XDG_DATA_HOME/boltwright, else
// ~/.local/share/boltwright. The folder may not exist yet. Fails if neither XDG_DATA_HOME nor HOME is set.
Result<std::filesystem::path> user_data_folder();

// Distinguishes two versions of a file without reading them. A missing file is a version too.
struct FileStamp {
    std::int64_t modified = 0;  // ns
    std::uint64_t size = 0, inode = 0;
    bool exists = false;
    friend bool operator==(const FileStamp&, const FileStamp&) = default;
};
// Returns the stamp of the file as it is now.
FileStamp stamp(const std::filesystem::path& file);

// Detects file changes by polling. Polling works on every file system, and with editors that write a new file
// and rename it over the old one. A change is reported only after the file has stayed unchanged for
// `settle_time` seconds, so that half-written files are not read.
class FileWatch {
  public:
    explicit FileWatch(double settle_time = 0.15) : settle_time_(settle_time) {}

    // Replaces the list of watched files. Files that were watched before keep their state.
    void watch(std::vector<std::filesystem::path> files);

    // Returns the files that changed since they were last reported, or since watching began. `now`: s, from
    // any monotonic clock.
    std::vector<std::filesystem::path> changed(double now);

  private:
    struct Watched {
        std::filesystem::path file;
        FileStamp reported, latest;
        std::optional<double> since;  // s, when `latest` was first observed; nullopt: it equals `reported`
    };
    double settle_time_;
    std::vector<Watched> files_;
};

}  // namespace bolt
