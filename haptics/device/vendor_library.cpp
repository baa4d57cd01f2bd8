#include "haptics/device/vendor_library.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bolt::device {

namespace {

bool is_name(const std::filesystem::path& candidate) { return !candidate.has_parent_path(); }

}  // namespace

Result<VendorLibrary> VendorLibrary::open(std::span<const std::filesystem::path> candidates) {
    std::string broken, why;  // a library that exists and cannot be loaded
    for (const std::filesystem::path& candidate : candidates) {
        std::error_code ignored;
        if (!is_name(candidate) && !std::filesystem::exists(candidate, ignored)) continue;
        // Local, so that symbols of two vendors never mix.
        if (void* handle = dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL); handle != nullptr) {
            VendorLibrary library;
            library.handle_ = handle;
            library.path_ = candidate;
            return library;
        }
        const char* error = dlerror();
        if (is_name(candidate) || error == nullptr) continue;
        broken = candidate.filename().string();
        why = error;
    }
    if (!broken.empty())
        return fail(ErrorCode::failed, fmt::format("{} cannot be loaded: {}", broken, why),
                    "the vendor's library for this kind of computer");
    const std::string name = candidates.empty() ? "library" : candidates.back().filename().string();
    return fail(ErrorCode::no_device, fmt::format("{} is not installed", name),
                "the vendor's library, installed");
}

Status VendorLibrary::check() const {
    if (missing_.empty()) return {};
    return fail(ErrorCode::failed, fmt::format("{} has no {}", path_.string(), fmt::join(missing_, ", ")),
                "the vendor's library for this kind of computer, in a version with these functions");
}

}  // namespace bolt::device
