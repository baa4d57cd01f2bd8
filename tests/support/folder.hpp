// A folder of a test's own, empty at first, that goes away with the test.
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

// In memory if there is such a place: for thousands of small files that would each wait for a busy disk.
std::filesystem::path place_in_memory();

}  // namespace bolt::test
