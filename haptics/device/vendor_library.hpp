// Loads a vendor's library at run time: nothing of the vendor is needed to build, and a computer without the
// library has the same program.
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
    // Loads the first of `candidates` that exists: a path, or a name without a slash, which the loader
    // searches. ErrorCode::no_device if none can be loaded; the error then states why the last existing one
    // could not. The library stays loaded until the program ends, because vendors' threads may outlive a
    // device.
    static Result<VendorLibrary> open(std::span<const std::filesystem::path> candidates);

    // Sets `function` to the symbol. A missing one is added to missing().
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
