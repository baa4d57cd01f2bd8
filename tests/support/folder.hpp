// A temporary folder that is removed with the object.
#pragma once

#include <filesystem>
#include <string>

namespace bolt::test {

class Folder {
  public:
    explicit Folder(const std::filesystem::path& inside = std::filesystem::temp_directory_path());
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder();
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

// Returns a folder in memory if there is one, for tests with thousands of small files.
std::filesystem::path place_in_memory();

}  // namespace bolt::test
