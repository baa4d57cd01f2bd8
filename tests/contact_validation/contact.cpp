// Tests of contact on the shipped assemblies against the contact oracle, with a few hundred of the 100,000
// poses that bolt-contact-validation checks.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "content/format/assembly.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tools/verify/contact/near_poses.hpp"
#include "tools/verify/contact/penetration_runs.hpp"

using namespace bolt;
using namespace bolt::contact_validation;

namespace {

constexpr double deepest_allowed = 100 * um;

struct ServoBench {
    servo::Setup setup;
    servo::State state;
    explicit ServoBench(const char* name) {
        const content::LoadedAssembly loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
        state = servo::initial_state(setup);
        Result<std::optional<servo::ToolContact>> contact =
            session::load_tool_contact(loaded.assembly, setup);
        REQUIRE(contact);
        REQUIRE(contact->has_value());
        state.tool_contact = std::move(*contact);
    }
};

const int sanitizer_divisor = test::sanitized ? 10 : 1;

// Shared, because loading takes seconds; no test changes it.
const ServoBench& zq350() {
    static const ServoBench bench("zq350");
    return bench;
}

}  // namespace

TEST_CASE("Contact validation: contacts near the ZQ350's obstacles are exact, and no crossing is missed") {
    const servo::ToolContact& contact = *zq350().state.tool_contact;
    const ContactScene scene = make_scene(contact.world, contact.wrench);
    const NearOptions options{
        .poses = static_cast<std::size_t>(300 / sanitizer_divisor), .seed = 5, .threads = 2};
    const std::vector<NearPose> poses = near_poses(scene, contact.world, contact.wrench, options);
    const NearSummary sum = summarize(poses, options.band);
    MESSAGE(to_text(sum));
    CHECK(sum.near > 40U / static_cast<unsigned>(sanitizer_divisor));
    CHECK(sum.deep > 40U / static_cast<unsigned>(sanitizer_divisor));
    CHECK(sum.missed == 0);
    CHECK(sum.point_error < 1 * um);
    CHECK(sum.distance_error < 1 * um);
    CHECK(sum.max_gap_overestimate_points < 1 * um);
    CHECK(sum.max_depth_underestimate_points < 1 * um);
    // Rows of short edges are taken as straight, and round faces are exact only at their sample points
    // (haptics/collision/samples.hpp).
    CHECK(sum.edge_error < 30 * um);
    CHECK(sum.max_gap_underestimate < 30 * um);
    CHECK(sum.max_gap_overestimate < 150 * um);
    // The checks detect contacts that are reported 0.5 mm too far away.
    std::vector<NearPose> wrong = poses;
    for (NearPose& pose : wrong) pose.reported += 500 * um;
    const NearSummary shifted = summarize(wrong, options.band);
    CHECK(shifted.max_gap_overestimate_points > 400 * um);
    CHECK(shifted.missed > 0);
}

TEST_CASE("Contact validation: the results do not depend on the number of threads") {
    const ServoBench bench("cover-m8");
    const servo::ToolContact& contact = *bench.state.tool_contact;
    const ContactScene scene = make_scene(contact.world, contact.wrench);
    const auto with = [&](unsigned threads) {
        return near_poses(scene, contact.world, contact.wrench, {.poses = 60, .seed = 2, .threads = threads});
    };
    const std::vector<NearPose> one = with(1), three = with(3);
    REQUIRE(one.size() == 60);
    REQUIRE(three.size() == one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].tool.position == three[i].tool.position);
        CHECK(one[i].reported == three[i].reported);
        CHECK(one[i].truth.gap == three[i].truth.gap);
    }
}

TEST_CASE(
    "Contact validation: the wrench is never deeper than 0.1 mm when flicked, in a slot, put onto nuts or "
    "pulled through obstacles") {
    if (test::sanitized) test::skip_part("the ZQ350 takes minutes under a sanitizer; cover-m8 instead");
    ServoBench bench(test::sanitized ? "cover-m8" : "zq350");
    const ContactScene scene = make_scene(bench.state.tool_contact->world, bench.state.tool_contact->wrench);
    const collision::ToolShape& tool = bench.state.tool_contact->wrench;
    const proxy::GodObjectParameters& parameters = bench.state.tool_contact->parameters;
    const auto check = [](const Result<PenetrationRun>& run) {
        REQUIRE(run);
        MESSAGE(to_text(*run));
        CHECK(run->checked > 100);
        CHECK(run->depth < deepest_allowed);
    };
    check(run_flicks(tool, parameters, 3, 10 / (test::sanitized ? 5 : 1)));
    check(run_in_slot(tool, parameters, collision::thickness(bench.setup.wrench.head), 3,
                      2000 / sanitizer_divisor));
    check(run_onto_nuts(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
    check(run_through_obstacles(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
}

TEST_CASE(
    "Contact validation: flats, throat and tips of the closed-form jaw lie on the mesh of each wrench") {
    for (const char* name : {"zq350", "cover-m8", "dn200-pn16"}) {
        CAPTURE(name);
        if (test::sanitized && std::string_view(name) == "dn200-pn16") {
            test::skip_part("loading the flange takes minutes under a sanitizer");
            continue;
        }
        std::optional<ServoBench> own;
        if (std::string_view(name) != "zq350") own.emplace(name);
        const ServoBench& bench = own ? *own : zq350();
        const auto& jaw = std::get<collision::Jaw>(bench.setup.wrench.head);
        const servo::ToolContact& contact = *bench.state.tool_contact;
        const ClosedSurface wrench = surface_of(contact.wrench.solid.mesh);
        const auto check_on_jaw = [&](double along, double across) {
            const Vec3 p = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(along, across, 0.0);
            CHECK(contact_oracle::nearest(wrench.tree, p, 1.0).distance < 20 * um);
            CHECK(collision::covered(contact.head, p));
        };
        check_on_jaw(jaw.depth, 0.0);
        for (const double side : {1.0, -1.0}) {
            check_on_jaw(0.0, 0.5 * side * jaw.opening);
            check_on_jaw(-jaw.tip, side * (0.5 * jaw.opening + 1.5 * jaw.lead_in));
        }
        // The closed form does not cover the fillets of the throat.
        const double in = 0.5 * jaw.opening * 0.98;
        const Vec3 corner = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(0.98 * jaw.depth, in, 0.0);
        CHECK(contact_oracle::winding(wrench, corner) == 1);
        CHECK_FALSE(collision::covered(contact.head, corner));
    }
}
