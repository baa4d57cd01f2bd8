// Left-hand threads: a pull on one is the mirror image of a pull on a right-hand thread.
#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"
#include "tests/servo/support.hpp"

namespace bolt::servo::left_thread {

namespace {

// The reflection at the plane z = 0. It contains the axes of both joints of test::two_joints, and their e1.
Vec3 mirrored(const Vec3& v) { return {v.x, v.y, -v.z}; }
// A torque is the cross product of two vectors, so its mirror image has the opposite sign.
Vec3 mirrored_torque(const Vec3& torque) { return -mirrored(torque); }

// The mirror image of a tool. A jaw is its own mirror image if it is turned over, rings, sockets and keys as
// they are. Both images have the handle on the same line.
CommandedTool mirrored(const CommandedTool& tool, bool turned_over) {
    CommandedTool image = tool;
    image.position[2] = -tool.position[2];
    const float w = tool.orientation[0], x = tool.orientation[1], y = tool.orientation[2],
                z = tool.orientation[3];
    // The image of a rotation has the quaternion (w, −x, −y, z); half a turn about the handle follows unless
    // the tool is turned over.
    const float over[4] = {w, -x, -y, z}, upright[4] = {x, w, z, y};
    for (int i = 0; i < 4; ++i) image.orientation[i] = turned_over ? over[i] : upright[i];
    return image;
}

Setup setup_of(const collision::ToolHead& head, joint::ThreadDirection direction,
               const force::OutputLimits& limits) {
    std::vector<joint::JointDesign> designs(2, test::m16_flange_joint());
    designs[1].seat = Vec3(0.2, 0.0, 0.0);
    for (joint::JointDesign& design : designs) {
        design.thread_direction = direction;
        design.start_gap = 0.2e-3;
        if (!std::holds_alternative<collision::HexKey>(head)) continue;
        design.form = joint::JointForm::tapped_hole;
        design.hole = {joint::tapped_material("C45").value(), 20e-3, 0.0};
        design.head = joint::HeadShape::socket;
        design.turned = joint::TurnedPart::head;
    }
    SetupDescription description;
    description.joints = designs;
    description.tool.head = head;
    if (const auto* jaw = std::get_if<collision::Jaw>(&head)) description.tool.head_angle = jaw->head_angle;
    description.tool.handle_length = 0.23;
    description.tool.click_swing = to_radians(2.0);
    description.max_torque = 210.0;
    description.limits = limits;
    description.seed = 3;
    return make_setup(description);
}

struct Case {
    const char* name;
    collision::ToolHead head;
    Grip grip = Grip::wrench;
    bool flipped = false;  // the tool on the right-hand thread
    bool renders_torque = true;
};

// A hand that approaches the nut, holds it, tightens it in strokes, loosens it again and leaves. It trembles.
class Hand {
  public:
    Hand(const Case& on, const Setup& setup) : case_(on), setup_(setup) {
        const double head = on.flipped ? setup.wrench.head_angle : -setup.wrench.head_angle;
        handle_ = (on.grip == Grip::wrench ? -head : 0.0) + to_radians(0.2);
    }
    // The command of a tick; none at the end.
    std::optional<TickInput> next(double nut_angle) {
        constexpr int approach = 400;
        // rad, positive tightens
        constexpr double strokes[] = {0.9, -0.4, 0.7, -0.3, 0.6, -1.2, -0.9};
        constexpr double step = 2e-3;
        Vec3 off(0.0);
        if (time_ < approach) {
            const double left = 1.0 - static_cast<double>(time_) / approach;
            off = left * Vec3(0.02, 0.05, 0.03);
        } else if (stroke_ < std::size(strokes)) {
            handle_ += std::copysign(step, strokes[stroke_]);
            turned_ += step;
            if (turned_ >= std::abs(strokes[stroke_])) {
                ++stroke_;
                turned_ = 0.0;
            }
        } else if (lifted_ < 0.06) {
            lifted_ += 2e-4;
            off.y = lifted_;
        } else {
            return std::nullopt;
        }
        ++time_;
        const NutGeometry& nut = setup_.nuts[0];
        const Vec3 tremor = 5e-5 * Vec3(random_.normal(), random_.normal(), random_.normal());
        TickInput input =
            test::holding(case_.grip, test::tool_at(nut, nut_centre(nut, nut_angle) + off + tremor,
                                                    handle_ + 1e-4 * random_.normal(), case_.flipped));
        input.guided_joint = 0;
        input.set_torque = 60.0F;
        return input;
    }

  private:
    Case case_;
    const Setup& setup_;
    Random random_{11, 1};
    double handle_ = 0.0, turned_ = 0.0, lifted_ = 0.0;
    std::size_t stroke_ = 0;
    int time_ = 0;
};

// The head of a ratchet; those of the other tools are made by the cases.
collision::Ring socket(double opening, double tooth_angle) {
    collision::Ring ring;
    ring.opening = opening;
    ring.low = -8e-3;
    ring.high = 6e-3;
    ring.lead_in = 1e-3;
    ring.outside = opening + 8e-3;
    ring.closed_above = tooth_angle > 0.0;
    ring.points = tooth_angle > 0.0 ? 6 : 12;
    ring.tooth_angle = tooth_angle;
    return ring;
}

}  // namespace

TEST_CASE("Left-hand thread: counter-clockwise seen from the nut moves it down by its lead, for any axis") {
    Random random(2);
    for (int trial = 0; trial < 50; ++trial) {
        const Vec3 axis =
            glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(0, 1e-3, 0));
        for (const double sense : {1.0, -1.0}) {
            Setup setup = test::two_joints({}, axis);
            NutGeometry& nut = setup.nuts[0];
            nut.sense = sense;
            const double angle = random.uniform(-3.0, 3.0), from = random.uniform(0.0, 3.0);
            const Pose before = nut_pose(nut, from), after = nut_pose(nut, from + 1.0);
            CHECK(glm::dot(before.position - after.position, nut.axis) ==
                  doctest::Approx(nut.lead).epsilon(1e-9));
            // Counter-clockwise, seen against the axis, is right-handed about it.
            const Vec3 turn = turn_between(before.orientation, after.orientation);
            CHECK(glm::length(turn + sense * nut.axis) < 1e-12);
            CHECK(loosening_axis(nut) == sense * nut.axis);

            const Vec3 direction = direction_at(nut, angle);
            CHECK(std::abs(glm::dot(direction, nut.axis)) < 1e-12);
            CHECK(angle_of(nut, 0.3 * direction + 2.0 * nut.axis) == doctest::Approx(angle).epsilon(1e-12));
            const Vec3 further = glm::angleAxis(-0.1 * sense, nut.axis) * direction;
            CHECK(glm::length(further - direction_at(nut, angle + 0.1)) < 1e-12);

            // The azimuth of a tool grows by as much as the tool turns, for either face of a jaw.
            for (const bool flipped : {false, true}) {
                const auto azimuth = [&](double handle) {
                    return tool_azimuth(setup, nut, tool_pose(test::tool_at(nut, Vec3(0.0), handle, flipped)),
                                        Grip::wrench);
                };
                CHECK(wrap(azimuth(0.4) - azimuth(0.2), 2.0 * pi) == doctest::Approx(0.2).epsilon(1e-5));
            }
        }
    }
}

TEST_CASE("Left-hand thread: the design decides, and its guiding hexagon is that of the nut") {
    const collision::ToolHead jaw = collision::make_jaw(24.2e-3, to_radians(15.0));
    CHECK(setup_of(jaw, joint::ThreadDirection::right, {}).nuts[1].sense == 1.0);
    const Setup setup = setup_of(jaw, joint::ThreadDirection::left, {});
    CHECK(setup.nuts[1].sense == -1.0);
    State state = initial_state(setup);
    state.joints[0].nut.angle = 0.37;
    const force::Hexagon hexagon = guide_target(setup, state.joints, 0).hexagon;
    const Pose nut = nut_pose(setup.nuts[0], 0.37);
    CHECK(glm::length(hexagon.flat - nut.orientation * Vec3(1, 0, 0)) < 1e-12);
    CHECK(glm::length(hexagon.across - glm::cross(hexagon.axis, hexagon.flat)) < 1e-12);
}

TEST_CASE("Left-hand thread: a pull is the mirror image of one on a right-hand thread, with each tool") {
    const collision::ToolHead jaw = collision::make_jaw(24.2e-3, to_radians(15.0));
    const collision::HexKey key{14e-3, -6e-3, 0.5e-3, 12e-3};
    const Case cases[] = {
        {"fingers", jaw, Grip::fingers},
        {"open end", jaw},
        {"open end, turned over", jaw, Grip::wrench, true},
        {"open end, on a device without torque", jaw, Grip::wrench, false, false},
        {"ring", socket(24.2e-3, 0.0)},
        {"ratchet", socket(24.2e-3, to_radians(5.0))},
        {"ratchet, on a device without torque", socket(24.2e-3, to_radians(5.0)), Grip::wrench, false, false},
        {"hexagon key", key},
    };
    for (const Case& one : cases) {
        CAPTURE(one.name);
        force::OutputLimits limits;
        if (!one.renders_torque) limits.torque = 0.0;
        const Setup right = setup_of(one.head, joint::ThreadDirection::right, limits),
                    left = setup_of(one.head, joint::ThreadDirection::left, limits);
        State on_right = initial_state(right), on_left = initial_state(left);
        Hand hand(one, right);
        const bool jaw_in_hand = std::holds_alternative<collision::Jaw>(one.head);
        double most = 0.0, force_error = 0.0, torque_error = 0.0, highest = 0.0, loosest = 0.0;
        int held = 0, clicks = 0;
        while (const auto input = hand.next(on_right.joints[0].nut.angle)) {
            TickInput image = *input;
            image.commanded_tool = mirrored(input->commanded_tool, jaw_in_hand);
            const Output a = tick(right, on_right, *input), b = tick(left, on_left, image);
            REQUIRE(a.joint == b.joint);
            REQUIRE(a.clicked == b.clicked);
            held += a.joint == 0 ? 1 : 0;
            clicks += a.clicked ? 1 : 0;
            REQUIRE(std::abs(a.nut_angle - b.nut_angle) < 1e-9);
            REQUIRE(std::abs(a.wrench_torque - b.wrench_torque) < 1e-6);
            REQUIRE(std::abs(a.clamp - b.clamp) < 1e-3);
            highest = std::max(highest, a.wrench_torque);
            loosest = std::min(loosest, a.wrench_torque);
            most = std::max({most, glm::length(a.force), glm::length(a.torque)});
            force_error = std::max(force_error, glm::length(b.force - mirrored(a.force)));
            torque_error = std::max(torque_error, glm::length(b.torque - mirrored_torque(a.torque)));
            REQUIRE(glm::length(b.constrained_tool.position - mirrored(a.constrained_tool.position)) < 1e-9);
        }
        CHECK(held > 1000);
        CHECK(most > 1.0);
        CHECK(force_error < 1e-6);
        CHECK(torque_error < 1e-6);
        if (one.grip == Grip::fingers) continue;
        CHECK(clicks > 0);
        CHECK(highest > 55.0);
        CHECK((loosest < -10.0 || collision::tooth_angle(one.head) > 0.0));
    }
}

}  // namespace bolt::servo::left_thread
