#include "game/study_journal/known_studies.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "engine/base/file.hpp"

namespace bolt::study {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_list = 16U << 20U;  // bytes

Error list_error(const fs::path& file, std::string what, std::string expected = {}) {
    Error error;
    error.file = file.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return error;
}

}  // namespace

Result<std::vector<fs::path>> known_studies(const fs::path& data) {
    std::vector<fs::path> studies;
    const fs::path file = data / known_studies_file_name;
    std::error_code unknown;
    if (!fs::exists(file, unknown)) return studies;
    BOLT_TRY_ASSIGN(const auto text, read_file(file, largest_list, ErrorCode::failed));
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        if (end > begin) studies.emplace_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return studies;
}

Status remember_study(const fs::path& data, const fs::path& study_folder) {
    std::error_code problem;
    fs::path folder = fs::weakly_canonical(fs::absolute(study_folder, problem), problem);
    if (folder.filename().empty()) folder = folder.parent_path();
    const fs::path file = data / known_studies_file_name;
    if (problem || folder.string().find('\n') != std::string::npos)
        return fail(
            list_error(study_folder, "this folder cannot be remembered", "a path without a line break"));
    BOLT_TRY_ASSIGN(const auto known, known_studies(data));
    if (std::find(known.begin(), known.end(), folder) != known.end()) return {};
    fs::create_directories(data, problem);
    // One write at the end of the file, so that two programs do not lose each other's line.
    const std::string line = folder.string() + "\n";
    const int handle = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    bool written =
        handle >= 0 && ::write(handle, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    written = written && ::fsync(handle) == 0;
    const int reason = errno;
    if (handle >= 0) (void)::close(handle);
    if (!written) return fail(list_error(file, std::string("cannot be written: ") + std::strerror(reason)));
    return {};
}

}  // namespace bolt::study
