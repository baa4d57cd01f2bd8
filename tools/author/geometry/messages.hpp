// Appends the findings of the checks, each with its position in the assembly file.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "content/format/json_document.hpp"
#include "tools/author/geometry/check.hpp"

namespace bolt::geometry {

struct Messages {
    const content::JsonDocument& document;
    Findings& findings;

    void error(std::string_view pointer, std::string what, std::string expected) const {
        findings.errors.push_back(
            document.error(pointer, content::JsonPart::value, std::move(what), std::move(expected)));
    }
    void note(std::string_view pointer, std::string what) const {
        findings.notes.push_back(document.error(pointer, content::JsonPart::value, std::move(what), {}));
    }
};

// JSON pointer of a joint or of one of its values.
inline std::string joint_pointer(std::size_t joint, std::string_view key = {}) {
    return key.empty() ? fmt::format("/joints/{}", joint) : fmt::format("/joints/{}/{}", joint, key);
}

// "[-75, 75, -125]": millimetres, rounded to 0.001 mm.
inline std::string in_mm(const Vec3& p) {
    const auto rounded = [](double x) { return std::round(x / mm * 1e3) / 1e3 + 0.0; };
    return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", rounded(p.x), rounded(p.y), rounded(p.z));
}

}  // namespace bolt::geometry
