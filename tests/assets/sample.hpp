// A model that uses every feature of the writer, with distinct values.
#pragma once

#include <filesystem>
#include <string>

#include "engine/assets/gltf.hpp"
#include "tests/support/folder.hpp"

namespace bolt::assets {

Model sample_model();

// A temporary file that the guard removes.
struct TemporaryFile {
    explicit TemporaryFile(const std::string& name) : path(folder / name) {}
    test::Folder folder;
    std::filesystem::path path;
};

}  // namespace bolt::assets
