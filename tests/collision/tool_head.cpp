// Rings, sockets and keys against closed-form results and against the separation of their solids.
#include "haptics/collision/tool_head.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/random.hpp"

namespace bolt::collision::tool_heads {

namespace {

constexpr double s = 24e-3, opening = 24.2e-3;
const HexagonPrism nut{s, 14.8e-3, 22.5e-3};
const HexagonSocket socket_of_m16{14.1e-3, 8e-3, 16e-3, 24e-3};

Ring ring(int points) { return {opening, points, -8.6e-3, 8.6e-3, 1.2e-3, 37e-3, false, 0.0}; }

Ring socket_on_ratchet() { return {opening, 12, -10.6e-3, 10.6e-3, 1.2e-3, 33e-3, true, to_radians(5.0)}; }

HexKey key() { return {14e-3, -4.2e-3, 1e-3, 30e-3, 0.0}; }

// A head and a shape with their solids.
struct Pair {
    ToolHead head;
    TurnedShape shape;
    std::vector<Convex> head_parts = head_solids(head).value();
    std::vector<Convex> shape_parts = shape_solids(shape).value();

    // Pose of the tool in the frame of the shape, at its grip height, its corners on those of the hexagon.
    [[nodiscard]] Pose tool(const Vec3& off = Vec3(0.0), double yaw = 0.0, double tilt = 0.0) const {
        const double corner = std::holds_alternative<HexKey>(head) ? pi / 6.0 : 0.0;
        const Quat turn = glm::angleAxis(tilt, Vec3(1, 0, 0)) * glm::angleAxis(yaw - corner, Vec3(0, 0, 1));
        return {off + Vec3(0, 0, grip_height(head, shape)), turn};
    }
    [[nodiscard]] std::vector<Contact> contacts(const Pose& tool, double band = 1e-3,
                                                const Pose& at = {}) const {
        std::array<Contact, max_grip_contacts> found;
        const GripQuery query{head, shape, {head_parts, shape_parts}, band, ObstacleId::nut(3)};
        const std::size_t count = grip_contacts(query, at * tool, at, found);
        return {found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count)};
    }
    [[nodiscard]] double apart(const Pose& tool) const {
        double least = 1.0;
        for (const Convex& a : head_parts)
            for (const Convex& b : shape_parts) least = std::min(least, separation(a, b, tool, 0.1).distance);
        return least;
    }
};

std::vector<Pair> pairs() {
    return {{ring(6), nut}, {ring(12), nut}, {socket_on_ratchet(), nut}, {key(), socket_of_m16}};
}

double nearest(const std::vector<Contact>& contacts) {
    double least = 1.0;
    for (const Contact& c : contacts) least = std::min(least, c.distance);
    return least;
}

}  // namespace

TEST_CASE("Tool head: jaws and rings turn hexagons, keys turn sockets") {
    const Jaw jaw = make_jaw(opening, 0.0);
    for (const ToolHead& head : {ToolHead(jaw), ToolHead(ring(12))}) {
        CHECK(grips(head, nut));
        CHECK_FALSE(grips(head, socket_of_m16));
    }
    CHECK(grips(key(), socket_of_m16));
    CHECK_FALSE(grips(key(), nut));
    CHECK(fitting_angle(jaw) == doctest::Approx(pi / 3));
    CHECK(fitting_angle(ring(6)) == doctest::Approx(pi / 3));
    CHECK(fitting_angle(ring(12)) == doctest::Approx(pi / 6));
    CHECK(fitting_angle(socket_on_ratchet()) == doctest::Approx(to_radians(5.0)));
}

TEST_CASE("Tool head: at the grip height the flats overlap as far as tool and part allow") {
    // The ring is higher than the nut, so it stands above the seat; its chamfer begins above the nut's.
    const Pair on_nut{ring(12), nut};
    const double low_flat = on_nut.tool().position.z - 8.6e-3 + 1.2e-3;
    const double drop = nut.corner_drop();
    CHECK(on_nut.tool().position.z - 8.6e-3 == doctest::Approx(0.3e-3).epsilon(1e-6));
    CHECK(head_fit(on_nut.head, nut, on_nut.tool()).overlap ==
          doctest::Approx(nut.height - drop - std::max(drop, low_flat)).epsilon(1e-9));
    // A key reaches to 0.3 mm above the bottom of the socket.
    const Pair in_screw{key(), socket_of_m16};
    CHECK(head_fit(in_screw.head, socket_of_m16, in_screw.tool()).overlap ==
          doctest::Approx(8e-3 - 0.3e-3 - 1e-3).epsilon(1e-9));
    // Lifted by half the overlap.
    const double half = 0.5 * head_fit(on_nut.head, nut, on_nut.tool()).overlap;
    HeadFit fit = head_fit(on_nut.head, nut, on_nut.tool({0, 0, half}));
    CHECK(fit.overlap == doctest::Approx(nut.height - drop - low_flat - half).epsilon(1e-9));
    CHECK(fit.surrounds(opening));
    fit = head_fit(on_nut.head, nut, on_nut.tool({0, 0, 2.01 * half}));
    CHECK_FALSE(fit.surrounds(opening));
    // Beside the nut at the same height.
    CHECK_FALSE(head_fit(on_nut.head, nut, on_nut.tool({0.05, 0, 0})).surrounds(opening));
}

TEST_CASE("Tool head: the misalignment repeats with the fitting angle, and a ratchet has none") {
    for (const double yaw : {0.01, -0.02, 0.2}) {
        CHECK(head_fit(ring(6), nut, Pair{ring(6), nut}.tool({}, yaw)).misalignment ==
              doctest::Approx(-yaw).epsilon(1e-9));
        CHECK(head_fit(ring(12), nut, Pair{ring(12), nut}.tool({}, yaw + pi / 6)).misalignment ==
              doctest::Approx(-yaw).epsilon(1e-9));
        CHECK(
            head_fit(key(), socket_of_m16, Pair{key(), socket_of_m16}.tool({}, yaw - pi / 3)).misalignment ==
            doctest::Approx(-yaw).epsilon(1e-9));
        const Pair ratchet{socket_on_ratchet(), nut};
        CHECK(std::abs(head_fit(ratchet.head, nut, ratchet.tool({}, yaw)).misalignment) < 1e-12);
        CHECK(nearest(ratchet.contacts(ratchet.tool({}, yaw))) ==
              doctest::Approx(nearest(ratchet.contacts(ratchet.tool()))));
    }
}

TEST_CASE("Tool head: a centred hexagon has half the clearance at each of the six walls, at both ends") {
    for (const Pair& pair : pairs()) {
        const double clearance = std::abs(width_across_flats(pair.head) - width_across_flats(pair.shape));
        std::vector<Contact> found = pair.contacts(pair.tool(), 0.2e-3);
        std::erase_if(found, [](const Contact& c) { return std::abs(c.normal.z) > 0.5; });
        REQUIRE(found.size() == 12);
        Vec3 sum(0.0);
        for (const Contact& c : found) {
            CHECK(c.distance == doctest::Approx(0.5 * clearance).epsilon(1e-6));
            CHECK(glm::length(c.normal) == doctest::Approx(1.0));
            CHECK(glm::length(c.on_obstacle + c.distance * c.normal - c.on_tool) < 1e-12);
            CHECK(c.obstacle == ObstacleId::nut(3));
            sum += c.normal;
        }
        CHECK(glm::length(sum) < 1e-9);
    }
}

TEST_CASE("Tool head: corners touch the walls when the head has turned by its play") {
    // The corner at half a side from the middle of its flat: cos ψ + sin ψ/√3 = w/s.
    for (const Pair& pair : {Pair{ring(6), nut}, Pair{ring(12), nut}, Pair{key(), socket_of_m16}}) {
        const double a = width_across_flats(pair.head), b = width_across_flats(pair.shape);
        const double w = std::max(a, b), flats = std::min(a, b);
        const double play = pi / 6.0 - std::acos(0.5 * std::sqrt(3.0) * w / flats);
        for (const double side : {1.0, -1.0}) {
            CHECK(std::abs(nearest(pair.contacts(pair.tool({}, side * play)))) < 1e-9);
            CHECK(nearest(pair.contacts(pair.tool({}, 1.2 * side * play))) < -1e-6);
        }
    }
}

TEST_CASE("Tool head: distances in the hole are those of the separating planes of the solids") {
    Random random(11);
    for (const Pair& pair : pairs()) {
        int compared = 0;
        for (int i = 0; i < 400; ++i) {
            const Pose at{{0.1, -0.2, 0.3}, glm::normalize(Quat(0.7, -0.2, 0.4, 0.5))};
            const double tilt = random.uniform(-0.002, 0.002);
            const Pose tool = pair.tool({random.normal() * 0.02e-3, random.normal() * 0.02e-3, 0.0},
                                        random.uniform(-0.004, 0.004), tilt);
            const std::vector<Contact> found = pair.contacts(tool, 1e-3, at);
            REQUIRE(!found.empty());
            // A ratchet turns its head until it fits; the solids here do not.
            if (tooth_angle(pair.head) > 0.0) continue;
            ++compared;
            // The middle of a flat reaches beyond the ends of the edges, by the height of the chamfer.
            const double apart = pair.apart(tool), beyond = std::abs(tilt) * 1.6e-3;
            CHECK(nearest(found) <= apart + beyond + 1e-9);
            CHECK(nearest(found) > apart - 2e-6);
        }
        CHECK((compared > 300 || tooth_angle(pair.head) > 0.0));
    }
}

TEST_CASE("Tool head: what does not fit rests on the end of the hexagon") {
    const Pair ring_above{ring(12), nut};
    const double on_top = nut.height + 8.6e-3 - grip_height(ring_above.head, nut);
    // Halfway between two fits a ring with 12 points stands on the corners of the nut.
    CHECK(nearest(ring_above.contacts(ring_above.tool({0, 0, on_top + 0.5e-3}, to_radians(15.0)))) > 0.2e-3);
    CHECK(nearest(ring_above.contacts(ring_above.tool({0, 0, on_top - 3e-3}, to_radians(15.0)))) < -0.5e-3);
    // In line it goes on.
    CHECK(nearest(ring_above.contacts(ring_above.tool({0, 0, on_top - 3e-3}))) > 0.0);
    const Pair key_above{key(), socket_of_m16};
    const double at_mouth = 16e-3 + 4.2e-3 - grip_height(key_above.head, socket_of_m16);
    CHECK(nearest(key_above.contacts(key_above.tool({0, 0, at_mouth - 2e-3}, to_radians(30.0)))) < -0.3e-3);
    CHECK(nearest(key_above.contacts(key_above.tool({0, 0, at_mouth - 2e-3}))) > 0.0);
}

TEST_CASE("Tool head: the shoulder of a socket and the bottom of a screw's socket stop the tool") {
    const Pair socket{socket_on_ratchet(), nut};
    // The shoulder meets the nut when the origin is 10.6 mm below its top.
    const double down = grip_height(socket.head, nut) - (nut.height - 10.6e-3);
    const std::vector<Contact> on_nut = socket.contacts(socket.tool({0, 0, 0.05e-3 - down}), 0.08e-3);
    REQUIRE(on_nut.size() == 6);
    for (const Contact& c : on_nut) {
        CHECK(c.distance == doctest::Approx(0.05e-3).epsilon(1e-6));
        CHECK(glm::length(c.normal - Vec3(0, 0, 1)) < 1e-9);
    }
    const Pair screw{key(), socket_of_m16};
    const std::vector<Contact> at_bottom = screw.contacts(screw.tool({0, 0, -0.28e-3}), 0.04e-3);
    REQUIRE(at_bottom.size() == 6);
    for (const Contact& c : at_bottom) CHECK(c.distance == doctest::Approx(0.02e-3).epsilon(1e-6));
}

TEST_CASE("Tool head: contacts change continuously while the head is pushed onto the hexagon") {
    for (const Pair& pair : {Pair{ring(6), nut}, Pair{ring(12), nut}, Pair{key(), socket_of_m16}}) {
        double before = 1.0;
        for (int i = 0; i <= 3000; ++i) {
            const double height = 30e-3 * (1.0 - i / 3000.0);
            const double now = std::min(1e-3, nearest(pair.contacts(pair.tool({0, 0, height}, 0.002), 2e-3)));
            CHECK(now > 0.0);
            if (i > 0) CHECK(std::abs(now - before) < 0.12e-3);
            before = now;
        }
    }
}

TEST_CASE("Tool head: beyond the reach of both solids and the band there are no contacts") {
    Random random(5);
    const double band = 5e-3;
    const auto any_direction = [&] {
        return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
    };
    std::vector<Pair> all = pairs();
    all.push_back({make_jaw(opening, to_radians(15.0)), nut});
    for (const Pair& pair : all) {
        const double reach = grip_reach({pair.head_parts, pair.shape_parts});
        double furthest = 0.0;  // m between the origins, with contacts
        for (int i = 0; i < 20'000; ++i) {
            const double distance = (reach + band) * random.uniform(0.3, 1.3);
            const Pose tool{distance * any_direction(), rotation(3.0 * random.uniform() * any_direction())};
            if (!pair.contacts(tool, band).empty()) furthest = std::max(furthest, distance);
        }
        CHECK(furthest <= reach + band);
        CHECK(furthest > 0.6 * (reach + band));  // a wide bound would test nothing
    }
}

}  // namespace bolt::collision::tool_heads
