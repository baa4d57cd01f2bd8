#include "haptics/collision/contact.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::collision {
namespace {

constexpr std::uint32_t unmerged = 0xffffffffU;

// The largest difference between the normals of a merged contact and of the nearer one. It is the length of
// the difference vector, which for unit vectors is at most the angle between them.
double normal_tolerance(double distance, double nearer_distance) {
    return merge_angle + (distance - nearer_distance) / merge_stride;
}

// The kept contacts in contiguous records.
struct KeptContacts {
    std::span<KeptContact> contacts;
    std::size_t count = 0;

    [[nodiscard]] const KeptContact* find_merge(const Contact& contact, double merge) const {
        for (const KeptContact& k : contacts.first(count)) {
            const Vec3 between = contact.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < square(merge)) || k.obstacle != contact.obstacle) continue;
            const Vec3 difference = contact.normal - k.normal;
            if (glm::dot(difference, difference) < square(normal_tolerance(contact.distance, k.distance)))
                return &k;
        }
        return nullptr;
    }

    // The kept contact that the deferred contact merges with whatever its exact position and normal are; null
    // if none.
    [[nodiscard]] const KeptContact* find_certain_merge(const DeferredContact& deferred, double merge) const {
        const double within = merge - static_cast<double>(deferred.position_error);
        if (!(within > 0.0)) return nullptr;
        for (const KeptContact& k : contacts.first(count)) {
            const Vec3 between = deferred.on_tool - k.on_tool;
            if (!(glm::dot(between, between) < square(within)) || k.obstacle != deferred.obstacle) continue;
            const double angle =
                normal_tolerance(deferred.lower, k.distance) - static_cast<double>(deferred.spread);
            // Upper bound of the cosine, from its series.
            const double cosine = 1.0 - square(angle) / 2.0 + square(square(angle)) / 24.0;
            if (angle > 0.0 && glm::dot(deferred.normal, k.normal) > std::min(cosine, 1.0)) return &k;
        }
        return nullptr;
    }
};

class Reducer {
  public:
    Reducer(ReductionInput& all, ResolveDeferred resolve) : all_(all), resolve_(resolve) {
        for (std::uint32_t i = 0; i < all.count; ++i) all.order[i] = ranked(i);
        std::sort(all.order.begin(), all.order.begin() + static_cast<std::ptrdiff_t>(all.count),
                  [&](const RankedContact& a, const RankedContact& b) { return precedes(a, b); });
        for (std::uint32_t i = 0; i < all.deferred.size(); ++i)
            all.deferred_order[i] = {all.deferred[i].lower, i, unmerged};
        const auto deferred = all.deferred_order.first(all.deferred.size());
        std::sort(deferred.begin(), deferred.end(), [](const RankedContact& a, const RankedContact& b) {
            return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
        });
    }

    // Selects the contacts to keep at this merge distance. Returns false if they do not fit `capacity`;
    // `complete_within` is then reduced to the distance of the first that did not fit.
    bool select(double merge, std::size_t capacity, double& complete_within) {
        ++iteration_;
        kept_ = {all_.kept, 0};
        std::size_t next = 0;
        std::size_t next_deferred = 0;
        for (;;) {
            // A deferred contact is resolved before any contact that might be further away.
            if (next_deferred < all_.deferred.size() &&
                (next == all_.count ||
                 all_.deferred_order[next_deferred].distance <= all_.order[next].distance)) {
                RankedContact& one = all_.deferred_order[next_deferred++];
                DeferredContact& deferred = all_.deferred[one.index];
                if (!is_certainly_merged(one, deferred, merge)) resolve(deferred, next);
                continue;
            }
            if (next == all_.count) return true;
            RankedContact& one = all_.order[next++];
            if (is_merged(one, merge)) continue;
            if (kept_.count == capacity) {
                complete_within = std::min(complete_within, one.distance);
                return false;
            }
            const Contact& contact = all_.found[one.index];
            kept_.contacts[kept_.count++] = {contact.on_tool, contact.normal, contact.distance,
                                             contact.obstacle, one.index};
            all_.kept_in[one.index] = iteration_;
        }
    }

    std::size_t write(std::span<Contact> out) const {
        for (std::size_t i = 0; i < kept_.count; ++i) out[i] = all_.found[kept_.contacts[i].index];
        return kept_.count;
    }

  private:
    RankedContact ranked(std::uint32_t i) {
        all_.kept_in[i] = 0;
        return {all_.found[i].distance, i, unmerged};
    }
    [[nodiscard]] bool precedes(const RankedContact& a, const RankedContact& b) const {
        return a.distance != b.distance ? a.distance < b.distance
                                        : nearer(all_.found[a.index], all_.found[b.index]);
    }

    // True if the contact that this one merged with at a smaller merge distance is kept again.
    [[nodiscard]] bool is_merged_again(const RankedContact& one) const {
        return one.merged_with != unmerged && all_.kept_in[one.merged_with] == iteration_;
    }

    // True also if the contact has been resolved already.
    bool is_certainly_merged(RankedContact& one, const DeferredContact& deferred, double merge) const {
        if (deferred.resolved || is_merged_again(one)) return true;
        const KeptContact* merged = kept_.find_certain_merge(deferred, merge);
        if (merged != nullptr) one.merged_with = merged->index;
        return merged != nullptr;
    }

    bool is_merged(RankedContact& one, double merge) const {
        if (is_merged_again(one)) return true;
        const KeptContact* merged = kept_.find_merge(all_.found[one.index], merge);
        if (merged != nullptr) one.merged_with = merged->index;
        return merged != nullptr;
    }

    // Computes the contact and inserts it in order, at or after `next`.
    void resolve(DeferredContact& deferred, std::size_t next) {
        deferred.resolved = true;
        Contact contact;
        if (!resolve_(deferred, contact)) return;
        if (all_.count == all_.found.size()) {
            all_.complete_within = std::min(all_.complete_within, contact.distance);
            return;
        }
        all_.found[all_.count] = contact;
        const RankedContact one = ranked(static_cast<std::uint32_t>(all_.count));
        const auto begin = all_.order.begin();
        const auto end = begin + static_cast<std::ptrdiff_t>(all_.count);
        const auto place =
            std::upper_bound(begin + static_cast<std::ptrdiff_t>(next), end, one,
                             [&](const RankedContact& a, const RankedContact& b) { return precedes(a, b); });
        std::copy_backward(place, end, end + 1);
        *place = one;
        ++all_.count;
    }

    ReductionInput& all_;
    ResolveDeferred resolve_;
    KeptContacts kept_;
    std::uint8_t iteration_ = 0;
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

ContactQueryResult reduce_contacts(ReductionInput all, ResolveDeferred resolve, std::span<Contact> out) {
    Reducer reducer(all, resolve);
    for (double merge = first_merge_distance;; merge *= 2.0) {
        double complete_within = all.complete_within;
        const bool fits = reducer.select(merge, out.size(), complete_within);
        if (!fits && 2.0 * merge <= last_merge_distance) continue;
        return {reducer.write(out), std::min(complete_within, all.complete_within), !fits};
    }
}

}  // namespace bolt::collision
