// A model that uses everything that the writer can write, with numbers that are easy to tell apart.
#pragma once

#include <filesystem>
#include <string>

#include "engine/assets/gltf.hpp"
#include "tests/support/folder.hpp"

namespace bolt::assets {

Model sample_model();

// A file of its own in the folder for temporary files, removed with the guard.
struct TemporaryFile {
    explicit TemporaryFile(const std::string& name) : path(folder / name) {}
    test::Folder folder;
    std::filesystem::path path;
};

}  // namespace bolt::assets
