// Contact on the shipped ZQ350 against brute force in double: a few hundred of what bolt-truth does a hundred
// thousand of.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "content/format/load.hpp"
#include "game/play/servo_setup.hpp"
#include "game/play/touch_models.hpp"
#include "tests/support/sanitized.hpp"
#include "tools/truth/near_poses.hpp"
#include "tools/truth/trips.hpp"

using namespace bolt;
using namespace bolt::truth;

namespace {

constexpr double um = 1e-6;
constexpr double deepest_allowed = 100 * um;

struct Bench {
    servo::Setup setup;
    servo::State state;
    explicit Bench(const char* name) {
        const content::Loaded loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        setup = play::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 0.001);
        state = servo::initial_state(setup);
        Result<std::optional<servo::Touch>> touch = play::load_touch(loaded.assembly, setup);
        REQUIRE(touch);
        REQUIRE(touch->has_value());
        state.touch = std::move(*touch);
    }
};

const int fewer = test::sanitized ? 10 : 1;

// Loading takes a while; nobody changes this one.
const Bench& zq350() {
    static const Bench bench("zq350");
    return bench;
}

}  // namespace

TEST_CASE("near poses on the ZQ350: what is told is true, and what is inside is told") {
    const servo::Touch& touch = *zq350().state.touch;
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
    // The check can fail: a finder that says of everything that it is half a millimetre further off.
    std::vector<NearPose> wrong = poses;
    for (NearPose& pose : wrong) pose.told += 500 * um;
    const NearSummary off = summarize(wrong, options.band);
    CHECK(off.later_than_points > 400 * um);
    CHECK(off.missed > 0);
}

TEST_CASE("whatever the number of threads, the same poses") {
    const Bench bench("cover-m8");
    const servo::Touch& touch = *bench.state.touch;
    const Scene scene = make_scene(touch.world, touch.wrench);
    const auto with = [&](unsigned threads) {
        return near_poses(scene, touch.world, touch.wrench, {.poses = 60, .seed = 2, .threads = threads});
    };
    const std::vector<NearPose> one = with(1), three = with(3);
    for (std::size_t i = 0; i < one.size(); ++i) {
        CHECK(one[i].tool.position == three[i].tool.position);
        CHECK(one[i].told == three[i].told);
        CHECK(one[i].truth.gap == three[i].truth.gap);
    }
}

TEST_CASE(
    "the wrench is never truly deeper than 0.1 mm: flicked, in a slot, at nuts, pulled through everything") {
    Bench bench(test::sanitized ? "cover-m8" : "zq350");
    const Scene scene = make_scene(bench.state.touch->world, bench.state.touch->wrench);
    const contact::ToolShape& tool = bench.state.touch->wrench;
    const contact::GodObjectParameters& parameters = bench.state.touch->parameters;
    const auto look = [](const Result<Trip>& trip) {
        REQUIRE(trip);
        MESSAGE(to_text(*trip));
        CHECK(trip->touching > 100);
        CHECK(trip->depth < deepest_allowed);
    };
    look(flicked(tool, parameters, 3, 10 / (test::sanitized ? 5 : 1)));
    look(in_a_slot(tool, parameters, bench.setup.wrench.jaw.thickness, 3, 2000 / fewer));
    look(at_nuts(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
    look(pulled_through(bench.setup, bench.state, scene, 3, test::sanitized ? 1 : 2));
}

TEST_CASE("the jaw's closed form has flats, throat and tips where each wrench has them") {
    for (const char* name : {"zq350", "cover-m8", "dn200-pn16"}) {
        CAPTURE(name);
        if (test::sanitized && std::string_view(name) == "dn200-pn16") continue;
        std::optional<Bench> own;
        if (std::string_view(name) != "zq350") own.emplace(name);
        const Bench& bench = own ? *own : zq350();
        const contact::Jaw& jaw = bench.setup.wrench.jaw;
        const servo::Touch& touch = *bench.state.touch;
        const Surface wrench = make_surface(touch.wrench.solid.mesh);
        const auto there = [&](double along, double across) {
            const Vec3 p = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(along, across, 0.0);
            CHECK(nearest(wrench.tree, p, 1.0).distance < 20 * um);
            CHECK(contact::stand_for(touch.jaw, p));
        };
        there(jaw.throat, 0.0);
        for (const double side : {1.0, -1.0}) {
            there(0.0, 0.5 * side * jaw.opening);
            there(-jaw.tip, side * (0.5 * jaw.opening + 1.5 * jaw.lead_in));
        }
        // But not for the fillets of the throat.
        const double in = 0.5 * jaw.opening * 0.98;
        const Vec3 corner = glm::angleAxis(jaw.head_angle, Vec3(0, 0, 1)) * Vec3(0.98 * jaw.throat, in, 0.0);
        CHECK(winding(wrench, corner) == 1);
        CHECK_FALSE(contact::stand_for(touch.jaw, corner));
    }
}
