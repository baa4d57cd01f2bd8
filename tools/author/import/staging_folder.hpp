// A temporary folder for the files of an import, so that the output folder never holds half of them.
#pragma once

#include <filesystem>

#include "engine/base/result.hpp"

namespace bolt::step_import {

// The folder is named .NAME.import-N and lies beside the output folder NAME, or inside it where a folder
// beside it cannot be created or is on another file system. Its creator holds a lock on it until it is
// removed; a folder without a lock was left by a program that was killed, and the next import to the same
// output folder removes it.
class StagingFolder {
  public:
    // Removes what killed imports to `output` have left, and creates the folder. Fails if it cannot be
    // created.
    static Result<StagingFolder> create(const std::filesystem::path& output);
    StagingFolder(StagingFolder&& other) noexcept;
    StagingFolder& operator=(StagingFolder&&) = delete;
    ~StagingFolder();  // removes the folder and what is left in it

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    // Renames the folder to the output folder, or, if that exists, moves every file into it. Fails if a file
    // cannot be moved.
    Status publish();

  private:
    StagingFolder(std::filesystem::path path, std::filesystem::path output, int lock)
        : path_(std::move(path)), output_(std::move(output)), lock_(lock) {}
    std::filesystem::path path_, output_;
    int lock_ = -1;
};

}  // namespace bolt::step_import
