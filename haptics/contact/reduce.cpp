#include "haptics/contact/reduce.hpp"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

const double alike = std::cos(merge_angle);

double squared(double x) { return x * x; }

// The contacts kept, and for looking through them fast the first of their points on the tool, dense.
struct Kept {
    static constexpr std::size_t dense = 64;
    std::span<Contact> room;
    std::size_t count = 0;
    std::array<Vec3, dense> points;

    void add(const Contact& contact) {
        if (count < dense) points[count] = contact.on_tool;
        room[count++] = contact;
    }
    template <class Is>
    [[nodiscard]] bool any_within(const Vec3& point, double squared, const Is& is) const {
        for (std::size_t i = 0; i < count; ++i) {
            const Vec3 between = point - (i < dense ? points[i] : room[i].on_tool);
            if (glm::dot(between, between) < squared && is(room[i])) return true;
        }
        return false;
    }
};

bool is_merged(const Contact& contact, const Kept& kept, double merge) {
    return kept.any_within(contact.on_tool, merge * merge, [&](const Contact& k) {
        return k.body == contact.body && glm::dot(k.normal, contact.normal) > alike;
    });
}

// Whatever it turns out to be.
bool is_surely_merged(const Waiting& waiting, const Kept& kept, double merge) {
    const auto blur = static_cast<double>(waiting.blur);
    if (!(blur < merge)) return false;
    const double within = squared(merge - blur);
    const double angle = merge_angle - static_cast<double>(waiting.spread);
    if (!(angle > 0.0)) return false;
    const double surely = 1.0 - squared(angle) / 2.0 + squared(squared(angle)) / 24.0;  // >= its cosine
    return kept.any_within(waiting.on_tool, within, [&](const Contact& k) {
        return k.body == waiting.body && glm::dot(k.normal, waiting.normal) > surely;
    });
}

class Reducer {
  public:
    Reducer(Reducing& all, FindWaiting find) : all_(all), find_(find) {
        for (std::uint32_t i = 0; i < all.count; ++i) all.order[i] = i;
        std::sort(all.order.begin(), all.order.begin() + static_cast<std::ptrdiff_t>(all.count),
                  [&](std::uint32_t a, std::uint32_t b) { return nearer(all.near[a], all.near[b]); });
        std::sort(all.waiting.begin(), all.waiting.end(), [](const Waiting& a, const Waiting& b) {
            if (a.lower != b.lower) return a.lower < b.lower;
            if (a.sample != b.sample) return a.sample < b.sample;
            return a.pair != b.pair ? a.pair < b.pair : a.of_tool < b.of_tool;
        });
    }

    // How many are kept; more than there is room for: false, with the first that found none.
    bool keep(double merge, std::span<Contact> out, Found& found) {
        Kept kept;
        kept.room = out;
        std::size_t next = 0;
        std::size_t waits = 0;
        for (;;) {
            // What waits is found before anything that might be further.
            if (waits < all_.waiting.size() &&
                (next == all_.count || all_.waiting[waits].lower <= at(next).distance)) {
                Waiting& waiting = all_.waiting[waits++];
                if (!waiting.found && !is_surely_merged(waiting, kept, merge)) find(waiting, next);
                continue;
            }
            found.count = kept.count;
            if (next == all_.count) return true;
            const Contact& contact = at(next++);
            if (is_merged(contact, kept, merge)) continue;
            if (kept.count == out.size()) {
                found.clearance = std::min(found.clearance, contact.distance);
                return false;
            }
            kept.add(contact);
        }
    }

  private:
    [[nodiscard]] const Contact& at(std::size_t i) const { return all_.near[all_.order[i]]; }

    // Puts it where it belongs, which is not before `next`.
    void find(Waiting& waiting, std::size_t next) {
        waiting.found = true;
        Contact contact;
        if (!find_(waiting, contact)) return;
        if (all_.count == all_.near.size()) {
            all_.clearance = std::min(all_.clearance, contact.distance);
            return;
        }
        all_.near[all_.count] = contact;
        const auto begin = all_.order.begin();
        const auto place = std::upper_bound(
            begin + static_cast<std::ptrdiff_t>(next), begin + static_cast<std::ptrdiff_t>(all_.count),
            static_cast<std::uint32_t>(all_.count),
            [&](std::uint32_t a, std::uint32_t b) { return nearer(all_.near[a], all_.near[b]); });
        std::copy_backward(place, begin + static_cast<std::ptrdiff_t>(all_.count),
                           begin + static_cast<std::ptrdiff_t>(all_.count) + 1);
        *place = static_cast<std::uint32_t>(all_.count++);
    }

    Reducing& all_;
    FindWaiting find_;
};

}  // namespace

bool nearer(const Contact& a, const Contact& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    if (a.feature != b.feature) return a.feature < b.feature;
    if (a.body != b.body) return a.body < b.body;
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    return false;
}

Found reduce(Reducing all, FindWaiting find, std::span<Contact> out) {
    Reducer reducer(all, find);
    for (double merge = merge_distance;; merge *= 2.0) {
        Found found{0, all.clearance, false};
        const bool fits = reducer.keep(merge, out, found);
        found.clearance = std::min(found.clearance, all.clearance);
        if (fits) return found;
        if (2.0 * merge > furthest_merge) {
            found.crowded = true;
            return found;
        }
    }
}

}  // namespace bolt::contact
