#include "content/format/folders.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "engine/base/file.hpp"

namespace bolt::content {

namespace fs = std::filesystem;

namespace {

bool holds_content(const fs::path& folder) {
    std::error_code ignored;
    return fs::is_regular_file(folder / "schema" / "assembly.schema.json", ignored);
}

// $XDG_DATA_DIRS or its default (XDG Base Directory Specification 0.8).
std::vector<fs::path> system_data_folders() {
    const char* given = std::getenv("XDG_DATA_DIRS");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    std::istringstream list(given != nullptr && *given != '\0' ? given : "/usr/local/share:/usr/share");
    std::vector<fs::path> folders;
    for (std::string folder; std::getline(list, folder, ':');)
        if (fs::path(folder).is_absolute()) folders.emplace_back(folder);
    return folders;
}

}  // namespace

fs::path content_folder() {
    if (const char* given =
            std::getenv("BOLTWRIGHT_CONTENT")) {  // NOLINT(concurrency-mt-unsafe): nothing sets it
        if (*given != '\0') return holds_content(given) ? fs::path(given) : fs::path{};
    }
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    for (fs::path folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
        if (holds_content(folder / "content")) return folder / "content";
        if (holds_content(folder / "share" / "boltwright" / "content"))
            return folder / "share" / "boltwright" / "content";
        if (folder == folder.root_path()) break;
    }
    for (const fs::path& folder : system_data_folders())
        if (holds_content(folder / "boltwright" / "content")) return folder / "boltwright" / "content";
    const fs::path source = BOLT_SOURCE_CONTENT;
    return holds_content(source) ? source : fs::path{};
}

std::vector<fs::path> assembly_folders() {
    std::vector<fs::path> folders;
    if (const auto data = user_data_folder()) folders.push_back(*data / "assemblies");
    if (const fs::path content = content_folder(); !content.empty())
        folders.push_back(content / "assemblies");
    return folders;
}

std::vector<std::string> assembly_names() {
    std::vector<std::string> names;
    for (const fs::path& folder : assembly_folders()) {
        std::error_code problem;
        for (fs::directory_iterator entry(folder, problem); !problem && entry != fs::directory_iterator();
             entry.increment(problem)) {
            std::error_code ignored;
            if (fs::exists(entry->path() / "assembly.json", ignored))
                names.push_back(entry->path().filename().string());
        }
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

fs::path assembly_folder(const std::string& name) {
    std::error_code ignored;
    for (const fs::path& folder : assembly_folders())
        if (fs::exists(folder / name / "assembly.json", ignored)) return folder / name;
    return name;
}

}  // namespace bolt::content
