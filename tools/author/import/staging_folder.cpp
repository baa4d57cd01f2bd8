#include "tools/author/import/staging_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace bolt::step_import {

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> cannot(const fs::path& file, const std::string& what) {
    Error error;
    error.code = ErrorCode::failed;
    error.file = file.string();
    error.what = what;
    return fail(std::move(error));
}

fs::path without_trailing_slash(const fs::path& path) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(path, ignored).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

// Returns the nearest folder above `output` that exists.
fs::path existing_parent(const fs::path& output) {
    std::error_code ignored;
    fs::path parent = output.parent_path();
    while (!fs::exists(parent, ignored) && parent.has_relative_path()) parent = parent.parent_path();
    return parent;
}

bool same_file_system(const fs::path& a, const fs::path& b) {
    struct stat of_a {
    }, of_b{};
    return ::stat(a.c_str(), &of_a) == 0 && ::stat(b.c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev;
}

// Returns a locked descriptor of the folder; −1 if another process holds the lock or the folder is gone.
int lock_folder(const fs::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return -1;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    (void)::close(file);
    return -1;
}

void remove_stale(const fs::path& parent, const std::string& prefix) {
    std::error_code problem;
    std::vector<fs::path> stale;
    for (fs::directory_iterator at(parent, problem), end; !problem && at != end; at.increment(problem))
        if (at->path().filename().string().starts_with(prefix)) stale.push_back(at->path());
    for (const fs::path& folder : stale)
        if (const int lock = lock_folder(folder); lock >= 0) {
            fs::remove_all(folder, problem);
            (void)::close(lock);
        }
}

}  // namespace

Result<StagingFolder> StagingFolder::create(const fs::path& output) {
    const fs::path whole = without_trailing_slash(output);
    const std::string prefix = "." + whole.filename().string() + ".import-";
    std::error_code ignored;
    const bool output_exists = fs::is_directory(whole, ignored);
    const fs::path beside = existing_parent(whole);
    std::vector<fs::path> parents;
    if (!output_exists || same_file_system(beside, whole)) parents.push_back(beside);
    if (output_exists) parents.push_back(whole);
    for (const fs::path& parent : parents) remove_stale(parent, prefix);
    int problem = 0;
    for (const fs::path& parent : parents) {
        for (int number = 1; number <= 1000; ++number) {
            const fs::path path = parent / (prefix + std::to_string(number));
            if (::mkdir(path.c_str(), 0777) != 0) {
                problem = errno;
                if (problem == EEXIST) continue;
                break;
            }
            // Another import may have taken the new folder for a stale one before it was locked.
            if (const int lock = lock_folder(path); lock >= 0) {
                if (fs::exists(path, ignored)) return StagingFolder(path, output, lock);
                (void)::close(lock);
            }
        }
    }
    return cannot(output, std::string("cannot be made: ") + std::strerror(problem));
}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : path_(std::move(other.path_)),
      output_(std::move(other.output_)),
      lock_(std::exchange(other.lock_, -1)) {}

StagingFolder::~StagingFolder() {
    if (lock_ < 0) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    (void)::close(lock_);
}

Status StagingFolder::publish() {
    std::error_code problem;
    if (!fs::exists(output_, problem)) {
        fs::create_directories(without_trailing_slash(output_).parent_path(), problem);
        fs::rename(path_, without_trailing_slash(output_), problem);
        if (!problem) {
            (void)::close(std::exchange(lock_, -1));
            return {};
        }
        if (!fs::is_directory(output_)) return cannot(output_, "cannot be made: " + problem.message());
    }
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_, problem))
        files.push_back(entry.path().filename());
    // Models before the assembly.json that names them.
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return std::pair(a.extension() == ".json", a) < std::pair(b.extension() == ".json", b);
    });
    for (const fs::path& file : files) {
        fs::rename(path_ / file, output_ / file, problem);
        if (problem) return cannot(output_ / file, "cannot be written: " + problem.message());
    }
    return {};
}

}  // namespace bolt::step_import
