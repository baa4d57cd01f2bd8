#include "engine/base/console.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace bolt {

int print_error(const Error& error) {
    // A message without a file name gets a prefix that marks it as an error.
    const char* prefix = error.file.empty() ? "error: " : "";
    (void)std::fprintf(stderr, "%s%s\n", prefix, error.message().c_str());
    return static_cast<int>(error.code);
}

int print_error(std::span<const Error> errors) {
    for (const Error& error : errors) (void)print_error(error);
    return errors.empty() ? 0 : static_cast<int>(errors.front().code);
}

Status print(std::string_view text) {
    const bool written =
        std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
    if (written) return {};
    return fail(ErrorCode::failed,
                std::string("the standard output cannot be written: ") + std::strerror(errno));
}

}  // namespace bolt
