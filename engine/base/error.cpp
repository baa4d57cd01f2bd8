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
    if (!expected.empty()) text += "; " + expected;
    return text;
}

}  // namespace bolt
