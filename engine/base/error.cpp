#include "engine/base/error.hpp"

#include <fmt/format.h>

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

}  // namespace bolt
