// Geometry of jaw and nut: how the jaw slides on, rests on top and comes off. On the M8 cover with the wrench
// of its lesson.
#include <algorithm>

#include "tests/support/forbidden.hpp"
#include "tests/tool_contact/support.hpp"

using namespace bolt;
using namespace bolt::servo;

namespace {

// Change of force in one tick that counts as a shock, as a share of the greatest force.
constexpr double shock = 0.1;

struct ForceRecord {
    double greatest = 0.0, step = 0.0;  // N
    int engaged_at = -1;                // ms
    Output last;
    int ticks = 0;

    void operator()(const Output& output) {
        greatest = std::max(greatest, glm::length(output.force));
        if (ticks > 0) step = std::max(step, glm::length(output.force - last.force));
        if (output.joint >= 0 && engaged_at < 0) engaged_at = ticks;
        last = output;
        ++ticks;
    }
};

// Lowers the wrench onto the nut of joint 0 and holds it there. `beside`: m along e1.
ForceRecord lowered(test::Workbench& bench, double misfit_deg, double beside) {
    const Pose high = bench.wrench(0, 0.03, to_radians(misfit_deg), {beside, 0, 0});
    const Pose low = bench.wrench(0, 0.0, to_radians(misfit_deg), {beside, 0, 0});
    for (int i = 0; i < 50; ++i) bench.step(high, Grip::none);
    for (int i = 0; i < 600; ++i) bench.step(high);
    ForceRecord felt;
    test::sweep(bench, high, low, 0.6, felt);
    for (int i = 0; i < 100; ++i) felt(bench.step(low));
    return felt;
}

double height(const test::Workbench& bench, const Output& output) {
    const NutGeometry& nut = bench.setup.nuts[0];
    return glm::dot(output.constrained_tool.position - nut_centre(nut, bench.state.joints[0].nut.angle),
                    nut.axis);
}

}  // namespace

TEST_CASE("Tool contact: a straight jaw slides onto the nut without force") {
    test::Workbench bench("cover-m8");
    const ForceRecord felt = lowered(bench, 0.0, 0.0);
    CHECK(felt.last.joint == 0);
    CHECK(felt.greatest < 0.05);
    CHECK(height(bench, felt.last) == doctest::Approx(0.0).epsilon(1e-4));
}

TEST_CASE("Tool contact: off centre the chamfer centres the jaw with a force and without a shock") {
    test::Workbench bench("cover-m8");
    for (const double misfit : {0.0, 0.6}) {
        CAPTURE(misfit);
        const ForceRecord felt = lowered(bench, misfit, 0.5e-3);
        CHECK(felt.last.joint == 0);
        CHECK(felt.greatest > 0.3);
        CHECK(felt.step < shock * bench.setup.limits.force);
    }
}

TEST_CASE("Tool contact: a misaligned jaw rests on the nut, and slides on once lifted and aligned") {
    test::Workbench bench("cover-m8");
    const ForceRecord standing = lowered(bench, 8.0, 0.0);
    CHECK(standing.last.joint == -1);
    CHECK(standing.last.contacts > 0);
    CHECK(height(bench, standing.last) > 0.5 * bench.setup.nuts[0].height);
    // The hand is in the nut, the wrench is not.
    CHECK(standing.greatest > 0.5 * bench.setup.limits.force);
    // Lift, turn and lower again.
    ForceRecord turning;
    test::sweep(bench, bench.wrench(0, 0.0, to_radians(8.0)), bench.wrench(0, 0.012, to_radians(8.0)), 0.3,
                turning);
    test::sweep(bench, bench.wrench(0, 0.012, to_radians(8.0)), bench.wrench(0, 0.0), 0.5, turning);
    for (int i = 0; i < 100; ++i) turning(bench.step(bench.wrench(0, 0.0)));
    CHECK(turning.last.joint == 0);
    CHECK(turning.step < shock * bench.setup.limits.force);
}

TEST_CASE(
    "Tool contact: the jaw leaves along the bolt without force, and then the nut is an obstacle again") {
    test::Workbench bench("cover-m8");
    lowered(bench, 0.0, 0.0);
    const Pose low = bench.wrench(0, 0.0), high = bench.wrench(0, 0.03);
    ForceRecord off;
    test::sweep(bench, low, high, 0.4, off);
    CHECK(off.last.joint == -1);
    CHECK(off.greatest < 0.5);
    ForceRecord aside;  // turned by 30 degrees and lowered again
    test::sweep(bench, high, bench.wrench(0, 0.03, to_radians(30.0)), 0.2, aside);
    test::sweep(bench, bench.wrench(0, 0.03, to_radians(30.0)), bench.wrench(0, 0.0, to_radians(30.0)), 0.5,
                aside);
    CHECK(aside.last.joint == -1);
    CHECK(height(bench, aside.last) > 0.5 * bench.setup.nuts[0].height);
}

TEST_CASE("Tool contact: the wrench stops at the cover however far the hand goes, and returns with it") {
    test::Workbench bench("cover-m8");
    const Pose high = bench.wrench(0, 0.03);
    Pose through = high;  // beside the nut and inside the plate
    through.position += bench.setup.nuts[0].axis * -0.06 + bench.setup.nuts[0].e1 * 0.03;
    for (int i = 0; i < 600; ++i) bench.step(high);
    ForceRecord in;
    double deepest = 1.0;
    test::sweep(bench, high, through, 0.5, [&](const Output& output) {
        in(output);
        if (output.contacts > 0) deepest = std::min(deepest, bench.state.tool_contact->last_step.nearest);
    });
    CHECK(deepest > -0.1e-3);
    CHECK(in.greatest > 0.5 * bench.setup.limits.force);
    CHECK(in.step < shock * bench.setup.limits.force);
    CHECK(glm::distance(in.last.constrained_tool.position, through.position) > 5e-3);
    ForceRecord back;
    test::sweep(bench, through, high, 0.5, back);
    for (int i = 0; i < 100; ++i) back(bench.step(high));
    CHECK(glm::distance(back.last.constrained_tool.position, high.position) < 1e-4);
    CHECK(glm::length(back.last.force) < 0.01);
}

TEST_CASE("Tool contact: the wrench stops with devices that render no force, no torque or neither") {
    for (const auto& [force, torque] : {std::pair{0.0, 0.0}, {0.0, 2.0}, {20.0, 0.0}}) {
        CAPTURE(force);
        CAPTURE(torque);
        force::OutputLimits limits;
        limits.force = force;
        limits.torque = torque;
        // As drivers report an arm without torque.
        if (torque == 0.0) limits.torsion = limits.angular_damping = 0.0;
        test::Workbench bench("cover-m8", limits);
        const Pose high = bench.wrench(0, 0.03);
        Pose through = high;
        through.position += bench.setup.nuts[0].axis * -0.06 + bench.setup.nuts[0].e1 * 0.03;
        for (int i = 0; i < 10; ++i) bench.step(high);
        double deepest = 1.0, felt = 0.0;
        Output last;
        test::sweep(bench, high, through, 0.5, [&](const Output& output) {
            last = output;
            felt = std::max(felt, glm::length(output.force));
            if (output.contacts > 0) deepest = std::min(deepest, bench.state.tool_contact->last_step.nearest);
        });
        CHECK(last.contacts > 0);
        CHECK(deepest > -0.1e-3);
        CHECK(glm::distance(last.constrained_tool.position, through.position) > 5e-3);
        CHECK(felt <= force);
        test::sweep(bench, through, high, 0.5, [&](const Output& output) { last = output; });
        CHECK(glm::distance(last.constrained_tool.position, high.position) < 1e-3);
    }
}

TEST_CASE("Tool contact: the same motion gives the same bits, and a tick makes no forbidden call") {
    test::Workbench first("cover-m8"), second("cover-m8");
    const Pose high = first.wrench(0, 0.03, to_radians(5.0)), low = first.wrench(0, 0.0, to_radians(5.0));
    bool same = true;
    std::vector<Output> outputs;
    outputs.reserve(1000);
    test::sweep(first, high, low, 0.4, [&](const Output& output) { outputs.push_back(output); });
    std::size_t i = 0;
    test::sweep(second, high, low, 0.4, [&](const Output& output) {
        const Output& other = outputs[i++];
        same = same && output.force == other.force && output.torque == other.torque &&
               output.constrained_tool.position == other.constrained_tool.position;
    });
    CHECK(same);
    CHECK(i == outputs.size());
    CHECK(outputs.back().contacts > 0);
    const test::Forbidden in_contact = test::forbidden_in([&] {
        for (int k = 0; k < 50; ++k) second.step(low);
    });
    CHECK(in_contact.all() == 0);
}
