#include "game/analysis/session_data.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "game/report/joint_map.hpp"
#include "tests/report/synthetic.hpp"
#include "tests/report/well_formed.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::report;

namespace {

// A session of one pass over five joints, taken in the order given.
SessionData session_of(const std::vector<std::size_t>& taken) {
    SessionData session;
    session.assembly = synthetic_assembly();
    session.assembly.joints.resize(5);
    session.assembly.passes = {{content::PassKind::tighten, 1.0, {0, 1, 2, 3, 4}}};
    session.joints = results_by_joint(session.assembly, {});
    session.curves.resize(5);
    for (std::size_t i = 0; i < taken.size(); ++i) {
        Visit visit;
        visit.begin = static_cast<double>(i);
        visit.worked = true;
        session.curves[taken[i]].visits.push_back(visit);
    }
    return session;
}

std::vector<std::size_t> out_of_turn(const PassOrder& order) {
    std::vector<std::size_t> joints;
    for (const OrderEntry& turn : order.actual)
        if (turn.out_of_turn) joints.push_back(turn.joint);
    return joints;
}

}  // namespace

TEST_CASE("Order: joints in the planned order are in turn") {
    const PassOrder order = pass_orders(session_of({0, 1, 2, 3, 4}))[0];
    CHECK(order.in_turn());
    CHECK(order.skipped_joints() == 0);
    CHECK(order.actual_position(3) == 4);
}

TEST_CASE("Order: the smallest set of joints is out of turn") {
    CHECK(out_of_turn(pass_orders(session_of({1, 2, 3, 4, 0}))[0]) == std::vector<std::size_t>{0});
    CHECK(out_of_turn(pass_orders(session_of({0, 3, 2, 1, 4}))[0]).size() == 2);
    const PassOrder skipped = pass_orders(session_of({0, 2, 3, 4}))[0];
    CHECK(skipped.in_turn());
    CHECK(skipped.skipped_joints() == 1);
    CHECK(skipped.actual_position(1) == 0);
}

TEST_CASE("Order: a repeated joint has one position and two visits") {
    const PassOrder order = pass_orders(session_of({0, 1, 0, 2, 3, 4}))[0];
    CHECK_FALSE(order.in_turn());
    CHECK(out_of_turn(order).empty());
    CHECK(order.visits(0) == 2);
    CHECK(order.actual_position(2) == 3);
}

TEST_CASE("Order: passes are separated by their events, and nuts that were only touched do not count") {
    SyntheticSession session = synthetic_session({});
    const std::vector<PassOrder> orders = pass_orders(session.data);
    REQUIRE(orders.size() == 4);
    CHECK(orders[0].label == "run-down");
    CHECK(orders[1].label == "30 %");
    for (const PassOrder& order : orders) {
        CHECK(order.actual.size() == 12);
        CHECK(order.in_turn());
    }
    session.data.pass_texts.clear();
    const std::vector<PassOrder> without_passes = pass_orders(session.data);
    REQUIRE(without_passes.size() == 1);
    CHECK(without_passes[0].planned.empty());
}

TEST_CASE("Joint map: keeps proportions, and all drawings are well-formed") {
    const SyntheticSession session = synthetic_session({});
    const JointMapLayout layout = joint_map_layout(session.data.assembly, 480.0, 40.0);
    REQUIRE(layout.positions.size() == 12);
    const double along = layout.positions[5].x - layout.positions[0].x,
                 across = layout.positions[6].y - layout.positions[0].y;
    CHECK(along == doctest::Approx(400.0));
    CHECK(across / along == doctest::Approx(0.24 / 0.64));
    for (const PassOrder& order : pass_orders(session.data))
        CHECK(markup_fault(order_map(session.data, order)) == "");
    CHECK(markup_fault(clamp_map(session.data)) == "");
    CHECK(markup_fault(clamp_rows(session.data)) == "");
}

TEST_CASE("Order: passes in the planned order share one drawing") {
    SyntheticOptions options;
    const SessionData good = synthetic_session(options).data;
    const std::vector<OrderDrawing> two =
        order_drawings(pass_orders(good));  // run-down and the cross pattern
    REQUIRE(two.size() == 2);
    CHECK(two[0].order.label == "run-down");
    CHECK(two[1].order.label == "30 %, 70 %, 100 %");
    CHECK(two[1].passes == 3);
    options.slips = true;
    const std::vector<OrderDrawing> slipped = order_drawings(pass_orders(synthetic_session(options).data));
    const auto wrong = [](const OrderDrawing& d) { return !d.order.as_planned(); };
    REQUIRE(std::any_of(slipped.begin(), slipped.end(), wrong));
    for (const OrderDrawing& d : slipped) CHECK((!wrong(d) || d.passes == 1));
}
