#include "haptics/contact/reduce.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

// How many are kept; more than there is room for: false, with the first that found none.
bool keep(std::span<const Contact> near, double merge, std::span<Contact> out, Found& found) {
    const double alike = std::cos(merge_angle);
    found.count = 0;
    for (const Contact& contact : near) {
        const auto kept = out.first(found.count);
        const bool merged = std::any_of(kept.begin(), kept.end(), [&](const Contact& k) {
            const Vec3 between = contact.on_tool - k.on_tool;
            return glm::dot(between, between) < merge * merge && k.body == contact.body &&
                   glm::dot(k.normal, contact.normal) > alike;
        });
        if (merged) continue;
        if (found.count == out.size()) {
            found.clearance = std::min(found.clearance, contact.distance);
            return false;
        }
        out[found.count++] = contact;
    }
    return true;
}

}  // namespace

bool nearer(const Contact& a, const Contact& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    if (a.feature != b.feature) return a.feature < b.feature;
    if (a.body != b.body) return a.body < b.body;
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    return false;
}

Found reduce(std::span<Contact> near, double clearance, std::span<Contact> out) {
    std::sort(near.begin(), near.end(), nearer);
    for (double merge = merge_distance;; merge *= 2.0) {
        Found found{0, clearance, false};
        if (keep(near, merge, out, found)) return found;
        if (2.0 * merge > furthest_merge) {
            found.crowded = true;
            return found;
        }
    }
}

}  // namespace bolt::contact
