// Forces while the tool slides over a faceted cylinder: smooth normals render it round, and the rate limits
// reduce changes that alternate from tick to tick.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>

#include "haptics/collision/narrow_phase.hpp"
#include "haptics/proxy/god_object.hpp"
#include "tests/collision/support.hpp"
#include "tests/proxy/scene.hpp"

namespace proxy_trembling_test {

using namespace bolt;
using namespace bolt::collision;
using namespace bolt::proxy;

namespace {

constexpr double dt = 1e-3;

// Second difference of the force over three ticks, N: root mean square and maximum.
class Trembling {
  public:
    void add(const Vec3& force) {
        if (n_ >= 2) {
            const double bend = glm::length(force - 2.0 * last_ + before_);
            sum_ += bend * bend;
            worst = std::max(worst, bend);
        }
        before_ = last_;
        last_ = force;
        ++n_;
    }
    [[nodiscard]] double rms() const { return std::sqrt(sum_ / std::max(1, n_ - 2)); }
    double worst = 0.0;

  private:
    Vec3 last_{0.0}, before_{0.0};
    double sum_ = 0.0;
    int n_ = 0;
};

ContactMesh cylinder(double radius, int sides) {
    contact_test::Triangles t;
    const auto at = [&](int i, double y) {
        const double a = 2.0 * pi * (i % sides) / sides;
        return Vec3(radius * std::sin(a), y, radius * std::cos(a));
    };
    constexpr double half = 0.05;
    for (int i = 0; i < sides; ++i) {
        t.quad(at(i, -half), at(i + 1, -half), at(i + 1, half), at(i, half));
        t.triangle(at(i, -half), Vec3(0, -half, 0), at(i + 1, -half));
        t.triangle(at(i, half), at(i + 1, half), Vec3(0, half, 0));
    }
    return t.mesh();
}

constexpr ForceRateLimits no_rate_limits{.tool_share_of_rendered = 10.0,
                                         .tool_share_of_maximum = 10.0,
                                         .total_share_of_maximum = 10.0,
                                         .any_direction_share = 1.0};

// Moves the device around the cylinder below its surface; the tool is a die that touches with one corner.
Trembling about_cylinder(int sides, bool smooth, const ForceRateLimits& rate_limits) {
    constexpr double radius = 0.02, depth = 4e-3, speed = 0.08, furthest = 0.4;
    const ContactMesh round = cylinder(radius, sides);
    const ContactMesh die = contact_test::box(Vec3(-5e-3), Vec3(5e-3)).mesh();
    const Obstacle still{ObstacleId::fixed(1), &round, {}, false};
    Result<CollisionWorld> world = make_world({&still, 1});
    REQUIRE(world);
    Result<ToolShape> tool = make_tool({&die, 1});
    REQUIRE(tool);
    NarrowPhaseState near = make_narrow_phase(*world, *tool);
    const auto finder = [&](const Pose& pose, double band, std::span<Contact> out) {
        const ContactQueryResult found = find_contacts(*world, *tool, pose, band, near, out);
        if (smooth) smooth_normals(*world, *tool, pose, out.first(found.count));
        return found;
    };
    GodObjectParameters p;
    p.coupling = proxy::make_coupling({});
    p.radius = tool->origin_radius();
    p.rate_limits = rate_limits;
    p.friction_coefficient = 0.1;
    // One corner points down.
    const Vec3 corner = glm::normalize(Vec3(-1.0)), down(0, 0, -1);
    const Quat turn = rotation(std::acos(glm::dot(corner, down)) * glm::normalize(glm::cross(corner, down)));
    const auto device = [&](double angle, double height) {
        return Pose{(radius + height) * Vec3(std::sin(angle), 0.0, std::cos(angle)) - p.radius * down, turn};
    };
    GodObjectState state = start_god_object(device(-furthest, 2e-3));
    const auto step = [&](double angle, double height) {
        step_god_object(p, state, device(angle, height), finder, dt);
        CHECK(signed_distance(*world, state.constrained_tool * (p.radius * corner)) > 0.0);
    };
    for (int i = 0; i <= 200; ++i) step(-furthest, 2e-3 - i / 200.0 * (depth + 2e-3));
    Trembling trembling;
    const int ticks = static_cast<int>(2.0 * furthest * radius / (speed * dt));
    for (int i = 0; i <= ticks; ++i) {
        step(furthest * (2.0 * i / ticks - 1.0), -depth);
        if (i > 50) trembling.add(state.rendered.force);
    }
    CHECK(glm::length(state.rendered.force) > 2.0);
    return trembling;
}

}  // namespace

TEST_CASE("God-object: with smooth normals a faceted bar renders as a round one") {
    for (const int sides : {16, 24, 48, 96}) {
        const Trembling facets = about_cylinder(sides, false, no_rate_limits),
                        smooth = about_cylinder(sides, true, no_rate_limits);
        MESSAGE(
            fmt::format("{} sides: the change of force changes by {:.4f} N in the mean, {:.3f} N at worst; "
                        "smooth by {:.4f} N and {:.3f} N",
                        sides, facets.rms(), facets.worst, smooth.rms(), smooth.worst));
        CHECK(facets.rms() > 0.2);
        CHECK(smooth.rms() < 0.01);
        CHECK(smooth.worst < 0.1);
    }
}

TEST_CASE("God-object: the rate limits reduce alternating forces, also without smooth normals") {
    for (const int sides : {16, 24, 48, 96}) {
        const Trembling free = about_cylinder(sides, false, no_rate_limits),
                        held = about_cylinder(sides, false, {}),
                        leaping = about_cylinder(sides, false, {.any_direction_share = 1.0});
        MESSAGE(fmt::format("{} sides: {:.3f} N free, {:.3f} N as it comes, {:.3f} N held", sides, free.rms(),
                            leaping.rms(), held.rms()));
        CHECK(held.rms() < 0.5 * free.rms());
        CHECK(held.worst < 0.6);
    }
}

}  // namespace proxy_trembling_test
