// Tables of points: any bytes give finite points or an error with a position, never a crash; what is aligned
// has a unit quaternion and residuals that are not negative.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/station/point_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto pairs = bolt::content::parse_point_pairs(text, "fuzz.csv");
    if (!pairs) {
        if (pairs.error().line < 1 || pairs.error().column < 1 || pairs.error().what.empty()) std::abort();
        return 0;
    }
    for (const bolt::PointPair& pair : *pairs)
        if (!bolt::finite(pair.from) || !bolt::finite(pair.to)) std::abort();
    const auto aligned = bolt::align_points(*pairs);
    if (!aligned) {
        if (aligned.error().what.empty() || aligned.error().detail == nullptr) std::abort();
        return 0;
    }
    const double length = glm::length(aligned->pose.orientation);
    if (!(length > 1.0 - 1e-12 && length < 1.0 + 1e-12) || !(aligned->rms >= 0.0)) std::abort();
    return 0;
}
