#include "haptics/contact/reduce.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

constexpr std::uint32_t nothing = 0xffffffffU;

double squared(double x) { return x * x; }

// By how much the normal of a contact that is merged may be off that of a nearer one: the length of the
// difference, which of unit vectors is at most the angle between them.
double may_be_off(double distance, double nearer_distance) {
    return merge_angle + (distance - nearer_distance) / merge_stride;
}

// Those kept, dense.
struct Kept {
    std::span<Core> cores;
    std::size_t count = 0;

    [[nodiscard]] const Core* merging(const Contact& contact, double merge) const {
        for (const Core& k : cores.first(count)) {
            const Vec3 between = contact.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < squared(merge)) || k.body != contact.body) continue;
            const Vec3 off = contact.normal - k.normal;
            if (glm::dot(off, off) < squared(may_be_off(contact.distance, k.distance))) return &k;
        }
        return nullptr;
    }

    // Whether all are merged, whatever they turn out to be.
    [[nodiscard]] const Core* surely_merging(const Waiting& waiting, double merge) const {
        const double within = merge - static_cast<double>(waiting.blur);
        if (!(within > 0.0)) return nullptr;
        for (const Core& k : cores.first(count)) {
            const Vec3 between = waiting.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < squared(within)) || k.body != waiting.body) continue;
            const double angle = may_be_off(waiting.lower, k.distance) - static_cast<double>(waiting.spread);
            // At least the cosine.
            const double cosine = 1.0 - squared(angle) / 2.0 + squared(squared(angle)) / 24.0;
            if (angle > 0.0 && glm::dot(waiting.normal, k.normal) > std::min(cosine, 1.0)) return &k;
        }
        return nullptr;
    }
};

class Reducer {
  public:
    Reducer(Reducing& all, FindWaiting find) : all_(all), find_(find) {
        for (std::uint32_t i = 0; i < all.count; ++i) all.order[i] = ranked(i);
        std::sort(all.order.begin(), all.order.begin() + static_cast<std::ptrdiff_t>(all.count),
                  [&](const Ranked& a, const Ranked& b) { return comes_before(a, b); });
        for (std::uint32_t i = 0; i < all.waiting.size(); ++i)
            all.waiting_order[i] = {all.waiting[i].lower, i, nothing};
        const auto waiting = all.waiting_order.first(all.waiting.size());
        std::sort(waiting.begin(), waiting.end(), [](const Ranked& a, const Ranked& b) {
            return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
        });
    }

    // Whether there was room for all; if not, the first that found none is in the clearance.
    bool keep(double merge, std::size_t room, double& clearance) {
        ++round_;
        kept_ = {all_.kept, 0};
        std::size_t next = 0;
        std::size_t waits = 0;
        for (;;) {
            // What waits is found before anything that might be further.
            if (waits < all_.waiting.size() &&
                (next == all_.count || all_.waiting_order[waits].distance <= all_.order[next].distance)) {
                Ranked& one = all_.waiting_order[waits++];
                Waiting& waiting = all_.waiting[one.index];
                if (!is_surely_merged(one, waiting, merge)) find(waiting, next);
                continue;
            }
            if (next == all_.count) return true;
            Ranked& one = all_.order[next++];
            if (is_merged(one, merge)) continue;
            if (kept_.count == room) {
                clearance = std::min(clearance, one.distance);
                return false;
            }
            const Contact& contact = all_.near[one.index];
            kept_.cores[kept_.count++] = {contact.on_tool, contact.normal, contact.distance, contact.body,
                                          one.index};
            all_.kept_in[one.index] = round_;
        }
    }

    std::size_t write(std::span<Contact> out) const {
        for (std::size_t i = 0; i < kept_.count; ++i) out[i] = all_.near[kept_.cores[i].index];
        return kept_.count;
    }

  private:
    Ranked ranked(std::uint32_t i) {
        all_.kept_in[i] = 0;
        return {all_.near[i].distance, i, nothing};
    }
    [[nodiscard]] bool comes_before(const Ranked& a, const Ranked& b) const {
        return a.distance != b.distance ? a.distance < b.distance
                                        : nearer(all_.near[a.index], all_.near[b.index]);
    }

    // What it was merged with at a lesser distance will do again, if it is kept again.
    [[nodiscard]] bool is_merged_again(const Ranked& one) const {
        return one.by != nothing && all_.kept_in[one.by] == round_;
    }

    // Or found.
    bool is_surely_merged(Ranked& one, const Waiting& waiting, double merge) const {
        if (waiting.found || is_merged_again(one)) return true;
        const Core* with = kept_.surely_merging(waiting, merge);
        if (with != nullptr) one.by = with->index;
        return with != nullptr;
    }

    bool is_merged(Ranked& one, double merge) const {
        if (is_merged_again(one)) return true;
        const Core* with = kept_.merging(all_.near[one.index], merge);
        if (with != nullptr) one.by = with->index;
        return with != nullptr;
    }

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
        const Ranked one = ranked(static_cast<std::uint32_t>(all_.count));
        const auto begin = all_.order.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(all_.count);
        const auto place =
            std::upper_bound(begin + static_cast<std::ptrdiff_t>(next), end, one,
                             [&](const Ranked& a, const Ranked& b) { return comes_before(a, b); });
        std::copy_backward(place, end, end + 1);
        *place = one;
        ++all_.count;
    }

    Reducing& all_;
    FindWaiting find_;
    Kept kept_;
    std::uint8_t round_ = 0;
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
        double clearance = all.clearance;
        const bool fits = reducer.keep(merge, out.size(), clearance);
        if (!fits && 2.0 * merge <= furthest_merge) continue;
        return {reducer.write(out), std::min(clearance, all.clearance), !fits};
    }
}

}  // namespace bolt::contact
