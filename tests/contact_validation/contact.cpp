// Contact on the shipped ZQ350 against the contact oracle: a few hundred of the poses of which
// bolt-contact-validation checks a hundred thousand.
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

constexpr double um = 1e-6;
constexpr double deepest_allowed = 100 * um;

struct Bench {
    servo::Setup setup;
    servo::State state;
    explicit Bench(const char* name) {
        const content::Loaded loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
        state = servo::initial_state(setup);
        Result<std::optional<servo::ToolContact>> touch = session::load_tool_contact(loaded.assembly, setup);
        REQUIRE(touch);
        REQUIRE(touch->has_value());
        state.tool_contact = std::move(*touch);
    }
};

const int fewer = test::sanitized ? 10 : 1;

// Shared, because loading takes seconds; no test changes it.
const Bench& zq350() {
    static const Bench bench("zq350");
    return bench;
}

}  // namespace

TEST_CASE("Contact validation: near poses on the ZQ350 have exact contacts, and no crossing is missed") {
    const servo::ToolContact& touch = *zq350().state.tool_contact;
    const Scene scene = make_scene(touch.world, touch.wrench);
    const NearOptions options{.poses = static_cast<std::size_t>(300 / fewer), .seed = 5, .threads = 2};
    const std::vector<NearPose> poses = near_poses(scene, touch.world, touch.wrench, options);
    const NearSummary sum = summarize(poses, options.band);
    MESSAGE(to_text(sum));
    CHECK(sum.near > 40U / static_cast<unsigned>(fewer));
    CHECK(sum.deep > 40U / static_cast<unsigned>(fewer));
    CHECK(sum.missed == 0);
    CHECK(sum.off < 1 * um);
    CHECK(sum.wrong < 1 * um);
    CHECK(sum.later_than_points < 1 * um);
    CHECK(sum.shallower_than_points < 1 * um);
    // Rows of short edges are taken for straight, round faces are known where they have points (samples.hpp).
    CHECK(sum.off_edges < 30 * um);
    CHECK(sum.nearer < 30 * um);
    CHECK(sum.later < 150 * um);
    // The check can fail: contacts that are reported half a millimetre too far away.
    std::vector<NearPose> wrong = poses;
    for (NearPose& pose : wrong) pose.told += 500 * um;
    const NearSummary off = summarize(wrong, options.band);
    CHECK(off.later_than_points > 400 * um);
    CHECK(off.missed > 0);
}

TEST_CASE("Contact validation: the poses do not depend on the number of threads") {
    const Bench bench("cover-m8");
    const servo::ToolContact& touch = *bench.state.tool_contact;
    const Scene scene = make_scene(touch.world, touch.wrench);
    const auto with = [&](unsigned threads) {
        return near_poses(scene, touch.world, touch.wrench, {.poses = 60, .seed = 2, .threads = threads});
    };
    const std::vector<NearPose> one = with(1), three = with(3);
    REQUIRE(one.size() == 60);
    REQUIRE(three.size() == one.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].tool.position == three[i].tool.position);
        CHECK(one[i].told == three[i].told);
        CHECK(one[i].truth.gap == three[i].truth.gap);
    }
}

TEST_CASE(
    "Contact validation: the wrench is never deeper than 0.1 mm, flicked, in a slot, at nuts, pulled through "
    "everything") {
    if (test::sanitized) test::skip_part("the ZQ350 takes minutes under a sanitizer; cover-m8 instead");
    Bench bench(test::sanitized ? "cover-m8" : "zq350");
    const Scene scene = make_scene(bench.state.tool_contact->world, bench.state.tool_contact->wrench);
    const collision::ToolShape& tool = bench.state.tool_contact->wrench;
    const proxy::GodObjectParameters& parameters = bench.state.tool_contact->parameters;
    const auto look = [](const Result<PenetrationRun>& run) {
        REQUIRE(run);
        MESSAGE(to_text(*run));
        CHECK(run->touching > 100);
        CHECK(run->depth < deepest_allowed);
    };
    look(flicked(tool, parameters, 3, 10 / (test::sanitized ? 5 : 1)));
    look(in_a_slot(tool, parameters, bench.setup.wrench.jaw.thickness, 3, 2000 / fewer));
    look(at_nuts(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
    look(pulled_through(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
}

TEST_CASE("Contact validation: the jaw's closed form has flats, throat and tips where each wrench has them") {
    for (const char* name : {"zq350", "cover-m8", "dn200-pn16"}) {
        CAPTURE(name);
        if (test::sanitized && std::string_view(name) == "dn200-pn16") {
            test::skip_part("loading the flange takes minutes under a sanitizer");
            continue;
        }
        std::optional<Bench> own;
        if (std::string_view(name) != "zq350") own.emplace(name);
        const Bench& bench = own ? *own : zq350();
        const collision::Jaw& jaw = bench.setup.wrench.jaw;
        const servo::ToolContact& touch = *bench.state.tool_contact;
        const Surface wrench = surface_of(touch.wrench.solid.mesh);
        const auto there = [&](double along, double across) {
            const Vec3 p = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(along, across, 0.0);
            CHECK(contact_oracle::nearest(wrench.tree, p, 1.0).distance < 20 * um);
            CHECK(collision::covered_by_jaw(touch.jaw, p));
        };
        there(jaw.throat, 0.0);
        for (const double side : {1.0, -1.0}) {
            there(0.0, 0.5 * side * jaw.opening);
            there(-jaw.tip, side * (0.5 * jaw.opening + 1.5 * jaw.lead_in));
        }
        // But not for the fillets of the throat.
        const double in = 0.5 * jaw.opening * 0.98;
        const Vec3 corner = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(0.98 * jaw.throat, in, 0.0);
        CHECK(contact_oracle::winding(wrench, corner) == 1);
        CHECK_FALSE(collision::covered_by_jaw(touch.jaw, corner));
    }
}
