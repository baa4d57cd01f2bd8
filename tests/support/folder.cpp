#include "tests/support/folder.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <cstdio>

namespace bolt::test {

namespace fs = std::filesystem;

Folder::Folder(const fs::path& inside) {
    std::string name = (inside / "boltwright-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        std::perror(name.c_str());
        std::abort();
    }
    path_ = name;
}

Folder::~Folder() {
    std::error_code ignored;
    fs::permissions(path_, fs::perms::owner_all, ignored);
    fs::remove_all(path_, ignored);
}

fs::path place_in_memory() {
    constexpr const char* in_memory = "/dev/shm";
    if (std::getenv("TMPDIR") == nullptr && ::access(in_memory, R_OK | W_OK | X_OK) == 0) return in_memory;
    return fs::temp_directory_path();
}

}  // namespace bolt::test
