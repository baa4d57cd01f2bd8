// Contact reduction: kept contacts also bound motions into merged ones, and deferred contacts give the same
// result as resolved ones.
#include "haptics/collision/contact.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <vector>

#include "haptics/proxy/constraint_solver.hpp"
#include "tests/collision/support.hpp"

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::proxy;
using namespace contact_test;

namespace {

// A vector of a random length up to `longest`.
Vec3 random_vector(Random& random, double longest) {
    const Vec3 direction = random_direction(random);
    return random.uniform(0.0, longest) * direction;
}

// Random contacts on four faces that are slightly curved.
std::vector<Contact> some_contacts(Random& random, std::size_t count, double size) {
    std::vector<Contact> all;
    std::array<Vec3, 4> faces{};
    for (Vec3& face : faces) face = random_direction(random);
    for (std::uint32_t i = 0; i < count; ++i) {
        Contact c;
        const double z = random.uniform(-1, 1);
        const double y = random.uniform(-1, 1);
        c.on_tool = size * Vec3(random.uniform(-1, 1), y, z);
        const Vec3 bend = random_vector(random, 0.6);
        c.normal = glm::normalize(faces[random.bits() % 4] + bend);
        c.distance = random.uniform(0.0, 0.6) * mm;
        c.obstacle = ObstacleId::nut(random.bits() % 2);
        c.feature = i;
        all.push_back(c);
    }
    return all;
}

struct ReductionBuffers {
    std::vector<Contact> near;
    std::vector<RankedContact> order{1024}, deferred_order{1024};
    std::vector<KeptContact> kept{1024};
    std::vector<std::uint8_t> kept_in = std::vector<std::uint8_t>(1024);

    ContactQueryResult reduce_contacts(std::span<const Contact> found, std::span<DeferredContact> deferred,
                                       ResolveDeferred find, std::span<Contact> out) {
        near.assign(found.begin(), found.end());
        near.resize(1024);
        return collision::reduce_contacts(
            {near, found.size(), order, kept, kept_in, deferred, deferred_order, 0.6 * mm}, find, out);
    }
};

double normal_motion(const Contact& c, const Twist& motion) {
    return glm::dot(c.normal, motion.linear + glm::cross(motion.angular, c.on_tool));
}

}  // namespace

TEST_CASE("Contact reduction: a motion allowed by the kept contacts stays within tolerance of merged ones") {
    Random random(71);
    ReductionBuffers buffers;
    std::array<Contact, 600> out;
    int merged = 0, moved = 0;
    double worst = 0.0;
    for (int set = 0; set < 20'000; ++set) {
        const std::vector<Contact> all = some_contacts(random, 1 + random.bits() % 8, 1.0 * mm);
        const ContactQueryResult found = buffers.reduce_contacts(
            all, {}, [](const DeferredContact&, Contact&) { return false; }, out);
        const auto kept = std::span(out).first(found.count);
        REQUIRE(!found.truncated);
        merged += static_cast<int>(all.size() - kept.size());
        for (int i = 0; i < 20; ++i) {
            // A motion nearly straight towards one contact, as far as all kept contacts allow.
            const Vec3 at = -all[random.bits() % all.size()].normal;
            const Vec3 aside = random_vector(random, 0.2);
            Twist motion{at + aside, random_vector(random, 1.0)};
            double share = merge_stride / travel(motion, 0.3);
            for (const Contact& c : kept)
                if (normal_motion(c, motion) < 0.0)
                    share = std::min(share, std::max(c.distance, 0.0) / -normal_motion(c, motion));
            motion = share * motion;
            moved += share > 0.0 ? 1 : 0;
            const double tolerance =
                merge_angle * merge_stride + first_merge_distance * glm::length(motion.angular);
            for (const Contact& c : all) {
                const double behind = -(c.distance + normal_motion(c, motion));
                worst = std::max(worst, behind / tolerance);
            }
        }
    }
    CHECK(worst <= 1.0);
    CHECK(merged > 5'000);
    CHECK(worst > 0.3);
    CHECK(moved > 100'000);
}

TEST_CASE("Contact reduction: deferred contacts give the same result as contacts known from the start") {
    Random random(72);
    ReductionBuffers buffers;
    int waited = 0, asked = 0;
    for (int set = 0; set < 500; ++set) {
        const std::vector<Contact> all = some_contacts(random, 250, 8.0 * mm);
        std::vector<Contact> there;
        std::vector<DeferredContact> deferred;
        for (const Contact& c : all) {
            if (random.chance(0.4)) {
                there.push_back(c);
                continue;
            }
            DeferredContact w;
            w.position_error = static_cast<float>(random.uniform(0.0, 0.6) * mm);
            w.spread = static_cast<float>(random.uniform(0.001, 0.3));
            w.lower = c.distance - random.uniform(0.0, 0.2) * mm;
            w.on_tool = c.on_tool + 0.999 * static_cast<double>(w.position_error) * random_direction(random);
            w.normal = rotation(0.99 * static_cast<double>(w.spread) * random_direction(random)) * c.normal;
            w.obstacle = c.obstacle;
            w.sample = c.feature;
            deferred.push_back(w);
        }
        const auto find = [&](const DeferredContact& w, Contact& c) {
            ++asked;
            c = all[w.sample];
            return true;
        };
        // The output alternates between enough room for all contacts and room for 32, which forces merging.
        std::array<Contact, 600> a, b;
        const std::size_t room = set % 2 == 0 ? 32 : 600;
        const ContactQueryResult x = buffers.reduce_contacts(all, {}, find, std::span(a).first(room));
        waited += static_cast<int>(deferred.size());
        const ContactQueryResult y = buffers.reduce_contacts(there, deferred, find, std::span(b).first(room));
        REQUIRE(x.count == y.count);
        REQUIRE(x.complete_within == y.complete_within);
        REQUIRE(x.truncated == y.truncated);
        for (std::size_t i = 0; i < x.count; ++i) REQUIRE(a[i].feature == b[i].feature);
    }
    CHECK(asked > 0.05 * waited);
    CHECK(asked < 0.95 * waited);
}
