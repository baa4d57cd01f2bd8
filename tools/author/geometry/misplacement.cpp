#include "tools/author/geometry/misplacement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "tools/author/geometry/messages.hpp"

namespace bolt::geometry {

namespace {

struct Turn {
    Vec3 (*apply)(const Vec3&);  // a point of the file, as the model has it
    const char* what;            // nullptr: not turned
    const char* expected;
};

constexpr Turn turns[] = {
    {[](const Vec3& p) { return p; }, nullptr, nullptr},
    {[](const Vec3& p) {
         return Vec3{p.x, -p.z, p.y};
     },
     "the model has Z up", "expected Y up, as glTF has it: bolt-author import-step turns it"},
    {[](const Vec3& p) {
         return Vec3{p.x, p.z, -p.y};
     },
     "the model has Y and Z exchanged (its up is -Z)",
     "expected Y up, as glTF has it: turn the model by 180 degrees less about X"},
    {[](const Vec3& p) {
         return Vec3{p.x, p.z, p.y};
     },
     "Y and Z are exchanged, as in a mirror",
     "expected Y up and no mirror: look at the order of the coordinates in the file"},
};

struct Scale {
    double factor;  // of the model over the file
    const char* what;
    const char* expected;
};

constexpr Scale scales[] = {
    {1.0, nullptr, nullptr},
    {1e3, "the model is in millimetres", "expected metres, as glTF has them: scale it by 0.001"},
    {1e2, "the model is in centimetres", "expected metres, as glTF has them: scale it by 0.01"},
    {1.0 / 0.0254, "the model is in inches", "expected metres, as glTF has them: scale it by 0.0254"},
    {1e-3, "the model is a thousand times too small", "expected metres, as glTF has them: scale it by 1000"},
    {1e-2, "the model is a hundred times too small", "expected metres, as glTF has them: scale it by 100"},
    {25.4, "the model is 25.4 times too large: millimetres were taken for inches",
     "expected metres: scale it by 1/25.4"},
    {1.0 / 25.4, "the model is 25.4 times too small: inches were taken for millimetres",
     "expected metres: scale it by 25.4"},
};

bool same_axis(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) <= axis_tolerance;
}

bool fits(const Placement& p, const Turn& turn, double factor) {
    const Vec3 there = factor * turn.apply(p.file);
    const double rounding = 1e-6 * glm::length(there);  // of single precision, and of a factor like 1/25.4
    return glm::length(p.model - there) <= position_tolerance * factor + rounding &&
           same_axis(p.model_axis, turn.apply(p.file_axis));
}

}  // namespace

bool agrees(const Placement& p) {
    return glm::length(p.model - p.file) <= position_tolerance && same_axis(p.model_axis, p.file_axis);
}

std::optional<Slip> common_slip(std::span<const Placement> placements) {
    if (placements.empty() || std::all_of(placements.begin(), placements.end(), agrees)) return std::nullopt;
    double furthest = 0.0;
    for (const Placement& p : placements) furthest = std::max(furthest, glm::length(p.file));
    for (const Turn& turn : turns)
        for (const Scale& scale : scales) {
            if (turn.what == nullptr && scale.what == nullptr) continue;
            if (!std::all_of(placements.begin(), placements.end(),
                             [&](const Placement& p) { return fits(p, turn, scale.factor); }))
                continue;
            // No machine is smaller than a millimetre: then it is the file that has metres.
            if (scale.factor == 1e3 && furthest < 2 * mm)
                return Slip{"position_mm is in metres", "expected millimetres: times 1000"};
            Slip slip{scale.what != nullptr ? scale.what : turn.what,
                      scale.what != nullptr ? scale.expected : turn.expected};
            if (scale.what != nullptr && turn.what != nullptr) {
                slip.what += fmt::format(", and {}", turn.what);
                slip.expected += fmt::format("; {}", turn.expected);
            }
            return slip;
        }
    const Vec3 shift = placements[0].model - placements[0].file;
    const bool shifted =
        placements.size() > 1 && std::all_of(placements.begin(), placements.end(), [&](const Placement& p) {
            return glm::length(p.model - p.file - shift) <= position_tolerance &&
                   same_axis(p.model_axis, p.file_axis);
        });
    if (shifted)
        return Slip{fmt::format("the whole model is shifted by {} mm", in_mm(shift)),
                    "expected one origin for the file and its model"};
    return std::nullopt;
}

}  // namespace bolt::geometry
