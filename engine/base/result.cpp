#include "engine/base/result.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace bolt {

std::string Error::message() const {
    std::string text;
    if (!file.empty()) {
        text += file;
        if (line > 0) text += fmt::format(":{}", line);
        if (line > 0 && column > 0) text += fmt::format(":{}", column);
        text += ": ";
    }
    if (!pointer.empty()) text += pointer + ": ";
    text += what;
    if (expected.empty()) return text;
    const bool complete = expected.starts_with("expected ") || expected.starts_with("did you mean ");
    text += (complete ? "; " : "; expected ") + expected;
    return text;
}

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
                std::string("the standard output cannot be written: ") + std::strerror(errno),
                "an open pipe or free space");
}

}  // namespace bolt
