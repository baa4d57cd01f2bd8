// Loads a vendor's library at run time, so that the build needs no files of the vendor and the same program
// runs on a computer without the library.
#pragma once

#include <dlfcn.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::device {

class VendorLibrary {
  public:
    // Loads the first of `candidates` that can be loaded: a path, or a name without a slash, which the loader
    // searches. If none can be loaded: ErrorCode::failed with the reason for the last path that exists, or
    // ErrorCode::no_device if no path exists. The library stays loaded until the program ends, because
    // vendors' threads may outlive a device.
    static Result<VendorLibrary> open(std::span<const std::filesystem::path> candidates);

    // Sets `function` to the symbol, or to null; check() then fails.
    template <class Function>
    void find(const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(dlsym(handle_, name));
        if (function == nullptr) missing_.emplace_back(name);
    }

    // The same for a symbol that older versions lack: null if it is missing.
    template <class Function>
    void find_optional(const char* name, Function*& function) {
        function = reinterpret_cast<Function*>(dlsym(handle_, name));
    }

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // Fails if find() has not found a symbol, and names it.
    [[nodiscard]] Status check() const;

  private:
    void* handle_ = nullptr;
    std::filesystem::path path_;
    std::vector<std::string> missing_;
};

}  // namespace bolt::device
