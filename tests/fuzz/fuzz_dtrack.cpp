// DTrack's packets: any bytes give finite poses or no frame, and a head that the filter keeps steady, never a
// crash.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "engine/tracking/dtrack.hpp"
#include "engine/tracking/head_filter.hpp"
#include "engine/tracking/recorded_poses.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt;
    using namespace bolt::tracking;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto frame = parse_dtrack(text)) {
        if (frame->bodies.size() > max_dtrack_bodies || frame->invalid_bodies < 0) std::abort();
        HeadFilterState state;
        double now = 0.0;
        for (const DtrackBody& body : frame->bodies) {
            const bool is_pose = finite(body.pose.position) && glm::length(body.pose.position) <= 1001.0 &&
                                 std::abs(glm::length(body.pose.orientation) - 1.0) < 1e-9;
            if (!is_pose || !(body.quality >= 0.0)) std::abort();
            // Bodies as the samples of one head: it may be anywhere, but stays a pose.
            const HeadSample sample{now, body.pose};
            const FilteredHead head = filter_head(state, {}, {&sample, 1}, now);
            if (!finite(head.pose.position) || std::abs(glm::length(head.pose.orientation) - 1.0) > 1e-9)
                std::abort();
            now += 0.016;
        }
    }
    const auto poses = parse_recorded_poses(text, "fuzz.csv");
    if (!poses && (poses.error().line < 1 || poses.error().what.empty())) std::abort();
    if (poses)
        for (const BodySample& pose : *poses)
            if (!finite(pose.pose.position) || !std::isfinite(pose.time)) std::abort();
    return 0;
}
