#include "haptics/collision/contact.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::collision {
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
    std::span<KeptContact> cores;
    std::size_t count = 0;

    [[nodiscard]] const KeptContact* merging(const Contact& contact, double merge) const {
        for (const KeptContact& k : cores.first(count)) {
            const Vec3 between = contact.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < squared(merge)) || k.obstacle != contact.obstacle) continue;
            const Vec3 off = contact.normal - k.normal;
            if (glm::dot(off, off) < squared(may_be_off(contact.distance, k.distance))) return &k;
        }
        return nullptr;
    }

    // Whether all are merged, whatever they turn out to be.
    [[nodiscard]] const KeptContact* surely_merging(const DeferredContact& deferred, double merge) const {
        const double within = merge - static_cast<double>(deferred.blur);
        if (!(within > 0.0)) return nullptr;
        for (const KeptContact& k : cores.first(count)) {
            const Vec3 between = deferred.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < squared(within)) || k.obstacle != deferred.obstacle) continue;
            const double angle =
                may_be_off(deferred.lower, k.distance) - static_cast<double>(deferred.spread);
            // At least the cosine.
            const double cosine = 1.0 - squared(angle) / 2.0 + squared(squared(angle)) / 24.0;
            if (angle > 0.0 && glm::dot(deferred.normal, k.normal) > std::min(cosine, 1.0)) return &k;
        }
        return nullptr;
    }
};

class Reducer {
  public:
    Reducer(ReductionInput& all, ResolveDeferred find) : all_(all), find_(find) {
        for (std::uint32_t i = 0; i < all.count; ++i) all.order[i] = ranked(i);
        std::sort(all.order.begin(), all.order.begin() + static_cast<std::ptrdiff_t>(all.count),
                  [&](const RankedContact& a, const RankedContact& b) { return comes_before(a, b); });
        for (std::uint32_t i = 0; i < all.deferred.size(); ++i)
            all.deferred_order[i] = {all.deferred[i].lower, i, nothing};
        const auto deferred = all.deferred_order.first(all.deferred.size());
        std::sort(deferred.begin(), deferred.end(), [](const RankedContact& a, const RankedContact& b) {
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
            if (waits < all_.deferred.size() &&
                (next == all_.count || all_.deferred_order[waits].distance <= all_.order[next].distance)) {
                RankedContact& one = all_.deferred_order[waits++];
                DeferredContact& deferred = all_.deferred[one.index];
                if (!is_surely_merged(one, deferred, merge)) find(deferred, next);
                continue;
            }
            if (next == all_.count) return true;
            RankedContact& one = all_.order[next++];
            if (is_merged(one, merge)) continue;
            if (kept_.count == room) {
                clearance = std::min(clearance, one.distance);
                return false;
            }
            const Contact& contact = all_.near[one.index];
            kept_.cores[kept_.count++] = {contact.on_tool, contact.normal, contact.distance, contact.obstacle,
                                          one.index};
            all_.kept_in[one.index] = round_;
        }
    }

    std::size_t write(std::span<Contact> out) const {
        for (std::size_t i = 0; i < kept_.count; ++i) out[i] = all_.near[kept_.cores[i].index];
        return kept_.count;
    }

  private:
    RankedContact ranked(std::uint32_t i) {
        all_.kept_in[i] = 0;
        return {all_.near[i].distance, i, nothing};
    }
    [[nodiscard]] bool comes_before(const RankedContact& a, const RankedContact& b) const {
        return a.distance != b.distance ? a.distance < b.distance
                                        : nearer(all_.near[a.index], all_.near[b.index]);
    }

    // What it was merged with at a lesser distance will do again, if it is kept again.
    [[nodiscard]] bool is_merged_again(const RankedContact& one) const {
        return one.by != nothing && all_.kept_in[one.by] == round_;
    }

    // Or found.
    bool is_surely_merged(RankedContact& one, const DeferredContact& deferred, double merge) const {
        if (deferred.found || is_merged_again(one)) return true;
        const KeptContact* with = kept_.surely_merging(deferred, merge);
        if (with != nullptr) one.by = with->index;
        return with != nullptr;
    }

    bool is_merged(RankedContact& one, double merge) const {
        if (is_merged_again(one)) return true;
        const KeptContact* with = kept_.merging(all_.near[one.index], merge);
        if (with != nullptr) one.by = with->index;
        return with != nullptr;
    }

    // Puts it where it belongs, which is not before `next`.
    void find(DeferredContact& deferred, std::size_t next) {
        deferred.found = true;
        Contact contact;
        if (!find_(deferred, contact)) return;
        if (all_.count == all_.near.size()) {
            all_.clearance = std::min(all_.clearance, contact.distance);
            return;
        }
        all_.near[all_.count] = contact;
        const RankedContact one = ranked(static_cast<std::uint32_t>(all_.count));
        const auto begin = all_.order.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(all_.count);
        const auto place = std::upper_bound(
            begin + static_cast<std::ptrdiff_t>(next), end, one,
            [&](const RankedContact& a, const RankedContact& b) { return comes_before(a, b); });
        std::copy_backward(place, end, end + 1);
        *place = one;
        ++all_.count;
    }

    ReductionInput& all_;
    ResolveDeferred find_;
    Kept kept_;
    std::uint8_t round_ = 0;
};

}  // namespace

bool nearer(const Contact& a, const Contact& b) {
    if (a.distance != b.distance) return a.distance < b.distance;
    if (a.feature != b.feature) return a.feature < b.feature;
    if (a.obstacle != b.obstacle) return a.obstacle < b.obstacle;
    for (int k = 0; k < 3; ++k)
        if (a.normal[k] != b.normal[k]) return a.normal[k] < b.normal[k];
    return false;
}

ContactQueryResult reduce_contacts(ReductionInput all, ResolveDeferred find, std::span<Contact> out) {
    Reducer reducer(all, find);
    for (double merge = first_merge_distance;; merge *= 2.0) {
        double clearance = all.clearance;
        const bool fits = reducer.keep(merge, out.size(), clearance);
        if (!fits && 2.0 * merge <= last_merge_distance) continue;
        return {reducer.write(out), std::min(clearance, all.clearance), !fits};
    }
}

}  // namespace bolt::collision
