// Vive trackers, which a client finds by their role.
#include "engine/xr/vive_trackers.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "engine/xr/pose_tracker.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

const Pose on_wrist{{0.3, 1.1, -0.4}, rotation({0.4, -0.2, 0.3})};

mock::Config with_trackers() {
    mock::Config config;
    config.extensions.emplace_back(mock::vive_tracker_extension);
    return config;
}

xr::ViveTrackers trackers_of(test::Program& program) {
    const std::optional<xr::HeadsetFrame> frame = program.frame();
    REQUIRE(frame.has_value());
    return frame->hands.trackers;
}

std::string fault_of(const xr::ViveTrackers& trackers, TrackerRole role) {
    const std::optional<Error> fault = xr::tracker_fault(trackers, role);
    return fault ? fault->message() : std::string();
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

bool is_bound(const test::MockRuntime& mock, const std::string& role) {
    const std::string line = "/interaction_profiles/htc/vive_tracker_htcx tracker_" + role +
                             " /user/vive_tracker_htcx/role/" + role + "/input/grip/pose";
    const std::vector<std::string> lines = mock->accepted_bindings();
    return std::find(lines.begin(), lines.end(), line) != lines.end();
}

void check_tracker(const std::optional<xr::ReportedPose>& pose, const Pose& expected) {
    REQUIRE(pose.has_value());
    CHECK(glm::length(pose->pose.position - expected.position) < 1e-6);
    CHECK(glm::length(turn_between(pose->pose.orientation, expected.orientation)) < 1e-5);
}

}  // namespace

TEST_CASE("Vive trackers: each role has a name, and the name is that of the role") {
    for (std::size_t i = 0; i < tracker_role_count; ++i) {
        const auto role = static_cast<TrackerRole>(i);
        CHECK(parse_tracker_role(name(role)) == role);
    }
    CHECK_FALSE(parse_tracker_role("wrist"));
}

TEST_CASE("Vive trackers: all roles are bound, and the pose of each tracker arrives by its role") {
    const test::MockRuntime mock(with_trackers());
    test::Program program;
    REQUIRE(program.connect());
    for (const std::string_view role : tracker_role_names) CHECK(is_bound(mock, std::string(role)));
    mock->set_vive_tracker({"A", "right_wrist", true, {on_wrist}});
    mock->set_vive_tracker({"B", "", true, {}});
    (void)program.focus();
    const xr::ViveTrackers trackers = trackers_of(program);
    CHECK(trackers.has_data);
    CHECK(trackers.available);
    check_tracker(trackers[TrackerRole::right_wrist], on_wrist);
    CHECK(trackers[TrackerRole::right_wrist]->tracked);
    CHECK(trackers.connected.count() == 1);
    CHECK(std::count_if(trackers.poses.begin(), trackers.poses.end(), [](const auto& p) { return !!p; }) ==
          1);
    CHECK(fault_of(trackers, TrackerRole::right_wrist).empty());
}

TEST_CASE(
    "Vive trackers: one that is hidden, lost, switched off or moved to another role has a clear fault") {
    const test::MockRuntime mock(with_trackers());
    test::Program program;
    REQUIRE(program.connect());
    mock::ViveTracker tracker{"A", "right_wrist", true, {on_wrist}};
    mock->set_vive_tracker(tracker);
    (void)program.focus();
    constexpr TrackerRole role = TrackerRole::right_wrist;
    tracker.at.tracked = false;
    mock->set_vive_tracker(tracker);
    xr::ViveTrackers trackers = trackers_of(program);
    check_tracker(trackers[role], on_wrist);  // estimated: drawn, with a warning
    CHECK(has(fault_of(trackers, role), "the Vive tracker right_wrist is not tracked; expected one that is"));
    tracker.at.valid = false;
    mock->set_vive_tracker(tracker);
    trackers = trackers_of(program);
    CHECK_FALSE(trackers[role]);
    CHECK(has(fault_of(trackers, role), "right_wrist is not tracked"));
    tracker.at = {on_wrist};
    tracker.role = "left_foot";
    mock->set_vive_tracker(tracker);
    trackers = trackers_of(program);
    CHECK_FALSE(trackers[role]);
    CHECK(fault_of(trackers, role) ==
          "no Vive tracker that is switched on has the role right_wrist; there are left_foot; expected a "
          "tracker with this role in the settings of the runtime");
    check_tracker(trackers[TrackerRole::left_foot], on_wrist);
    tracker.role = "right_wrist";
    mock->set_vive_tracker(tracker);
    CHECK(fault_of(trackers_of(program), role).empty());
    // The runtime sends no event for this one.
    tracker.connected = false;
    mock->set_vive_tracker(tracker);
    trackers = trackers_of(program);
    CHECK_FALSE(trackers[role]);
    CHECK(has(fault_of(trackers, role), "right_wrist is not tracked"));
    for (int i = 0; i < 90; ++i) trackers = trackers_of(program);
    CHECK(has(fault_of(trackers, role), "no Vive tracker that is switched on has the role right_wrist; exp"));
    tracker.connected = true;
    mock->set_vive_tracker(tracker);
    check_tracker(trackers_of(program)[role], on_wrist);
}

TEST_CASE("Vive trackers: without focus nothing is known, and without the extension this is the fault") {
    {
        const test::MockRuntime mock(with_trackers());
        test::Program program;
        REQUIRE(program.connect());
        mock->set_vive_tracker({"A", "right_wrist", true, {on_wrist}});
        (void)program.focus();
        mock->send(mock::Event::focus_lost);
        (void)program.frame();
        const xr::ViveTrackers trackers = trackers_of(program);
        CHECK_FALSE(trackers.has_data);
        CHECK(fault_of(trackers, TrackerRole::right_wrist).empty());
    }
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK(
        has(fault_of(trackers_of(program), TrackerRole::waist), "it lacks XR_HTCX_vive_tracker_interaction"));
    CHECK(mock->calls("xrEnumerateViveTrackerPathsHTCX") == 0);
    CHECK_FALSE(is_bound(mock, "waist"));
}

TEST_CASE("Vive trackers: roles that an older runtime does not know leave the others bound") {
    for (const bool refuses_actions : {false, true}) {
        mock::Config config = with_trackers();
        config.unknown_roles = {"handheld_object", "left_wrist", "right_wrist", "left_ankle", "right_ankle"};
        config.refuses_unknown_roles = refuses_actions;
        const test::MockRuntime mock(config);
        test::Program program;
        REQUIRE(program.connect());
        for (const std::string_view role : tracker_role_names) {
            const bool unknown = std::find(config.unknown_roles.begin(), config.unknown_roles.end(), role) !=
                                 config.unknown_roles.end();
            CHECK(is_bound(mock, std::string(role)) == !unknown);
        }
        mock->set_vive_tracker({"A", "right_elbow", true, {on_wrist}});
        (void)program.focus();
        check_tracker(trackers_of(program)[TrackerRole::right_elbow], on_wrist);
    }
    mock::Config config = with_trackers();
    config.unknown_profiles = {"/interaction_profiles/htc/vive_tracker_htcx"};
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK(trackers_of(program).available);
}

TEST_CASE("Vive trackers: a runtime that refuses their calls is used without them") {
    const test::MockRuntime mock(with_trackers());
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->fail_next("xrEnumerateViveTrackerPathsHTCX", XR_ERROR_RUNTIME_FAILURE, 1);
    mock->set_vive_tracker({"A", "waist", true, {on_wrist}});
    check_tracker(trackers_of(program)[TrackerRole::waist], on_wrist);
    mock->fail_next("xrEnumerateViveTrackerPathsHTCX", XR_ERROR_INSTANCE_LOST, 1);
    mock->set_vive_tracker({"A", "chest", true, {on_wrist}});
    CHECK_FALSE(program.frame());
    CHECK_FALSE(program.headset().connected());
    // The first 8 actions are those of the hands.
    mock->fail_after("xrCreateAction", 8, XR_ERROR_VALIDATION_FAILURE, 1);
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK_FALSE(is_bound(mock, "handheld_object"));
    check_tracker(trackers_of(program)[TrackerRole::chest], on_wrist);
}

TEST_CASE("PoseTracker: a Vive tracker by its role, and why it has no pose") {
    const test::MockRuntime mock(with_trackers());
    auto opened = xr::PoseTracker::open(TrackerRole::left_wrist);
    REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
    xr::PoseTracker& tracker = **opened;
    const auto read = [&] {
        const auto pose = tracker.read();
        REQUIRE(pose);
        return *pose;
    };
    (void)read();  // the session has no focus yet
    CHECK_FALSE(read());
    CHECK(has(tracker.fault(), "no Vive tracker that is switched on has the role left_wrist"));
    mock->set_vive_tracker({"A", "left_wrist", true, {on_wrist, true, false}});
    CHECK_FALSE(read());
    CHECK(has(tracker.fault(), "left_wrist is not tracked"));
    mock->set_vive_tracker({"A", "left_wrist", true, {on_wrist}});
    const std::optional<Pose> pose = read();
    REQUIRE(pose);
    CHECK(glm::length(pose->position - on_wrist.position) < 1e-6);
    CHECK(tracker.fault().empty());
    CHECK_FALSE(tracker.pressed());
}

TEST_CASE("PoseTracker: a runtime without Vive trackers, or without the role, is an error") {
    {
        const test::MockRuntime mock;
        const auto tracker = xr::PoseTracker::open(TrackerRole::left_wrist);
        REQUIRE_FALSE(tracker);
        CHECK(tracker.error().code == ErrorCode::no_device);
        CHECK(
            has(tracker.error().message(), "it lacks XR_HTCX_vive_tracker_interaction; expected a runtime"));
    }
    mock::Config config = with_trackers();
    config.unknown_roles = {"left_wrist"};
    const test::MockRuntime mock(config);
    const auto tracker = xr::PoseTracker::open(TrackerRole::left_wrist);
    REQUIRE_FALSE(tracker);
    CHECK(has(tracker.error().message(), "does not know the role left_wrist of a Vive tracker; expected"));
}
