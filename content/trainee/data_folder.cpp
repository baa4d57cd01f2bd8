#include "content/trainee/data_folder.hpp"

#include <fmt/format.h>

#include <cstdlib>

namespace bolt::content {

namespace fs = std::filesystem;

Result<fs::path> data_folder() {
    // NOLINTBEGIN(concurrency-mt-unsafe): nothing sets them
    if (const char* data = std::getenv("XDG_DATA_HOME"); data != nullptr && fs::path(data).is_absolute())
        return fs::path(data) / "boltwright";
    if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
        return fs::path(home) / ".local" / "share" / "boltwright";
    // NOLINTEND(concurrency-mt-unsafe)
    return fail(ErrorCode::usage, "there is no home folder that anything could be kept in",
                "one in the environment's HOME, or the place itself");
}

std::string file_name_of(std::string_view trainee) {
    std::string name;
    for (const char c : trainee) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
        name += plain ? std::string(1, c) : fmt::format("_{:02x}", static_cast<unsigned char>(c));
    }
    return name;
}

}  // namespace bolt::content
