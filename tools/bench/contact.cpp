// Contact queries, tick by tick along a path of the wrench near and on the casing. A benchmark iteration is
// the whole path. The counters are microseconds of this thread's CPU time, the least of three rounds for each
// tick. `touching_*`: only ticks with contacts; `after_load`: the first tick.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>
#include <memory>

#include "haptics/collision/narrow_phase.hpp"
#include "tools/bench/contact_peers.hpp"
#include "tools/bench/need.hpp"
#include "tools/bench/sweep.hpp"
#include "tools/bench/tick_times.hpp"

namespace {

using namespace bolt;
using bench::guarded;
using bench::need;

std::string content() {
    const char* set = std::getenv("BOLTWRIGHT_CONTENT");
    return set != nullptr ? set : "content";
}

constexpr double band = 0.6e-3;
constexpr double longest_of_a_million = 8.5e-3;  // m: the longest edge for about a million triangles

constexpr double seconds = 24.0;  // of the path
constexpr int rounds = 3;         // the least time of each tick counts

// Arguments 0, 1: the casing as shipped (about 60,000 triangles) and refined.
struct Ground {
    std::array<std::vector<collision::ContactMesh>, 2> casings;
    std::array<collision::World, 2> worlds;
    std::vector<collision::ContactMesh> wrench;
    collision::ToolShape tool;
    std::vector<Pose> sweep;

    static const Ground& get() {
        static const Ground ground;
        return ground;
    }
    [[nodiscard]] collision::World world(std::size_t casing, double cell) const {
        std::vector<collision::Obstacle> obstacles;
        for (const collision::ContactMesh& part : casings[casing])
            obstacles.push_back({collision::ObstacleId::fixed(obstacles.size()), &part, {}, false});
        return need(collision::make_world(obstacles, {cell}));
    }

  private:
    Ground() {
        casings[0] = need(
            bench::load_contact(content() + "/assemblies/zq350/zq350.contact.glb", {"casing_", "wheel_"}));
        for (const collision::ContactMesh& part : casings[0])
            casings[1].push_back(bench::refined(part, longest_of_a_million));
        for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i] = world(i, collision::WorldOptions{}.cell);
        wrench = need(bench::load_contact(content() + "/tools/wrench-24.contact.glb"));
        tool = need(collision::make_tool(wrench));
        sweep = bench::make_sweep(worlds[0], worlds[0].shapes[0].solid, tool, 0.1e-3, seconds);
    }
};

class Ticks {
  public:
    void add(double took, bool touches, bool follows) {
        if (!follows) return first_.push_back(took);
        all_.push_back(took);
        if (touches) touching_.push_back(took);
    }
    void tell(benchmark::State& state) {
        state.counters["p50"] = bench::quantile(all_, 0.5);
        state.counters["p99"] = bench::quantile(all_, 0.99);
        state.counters["p99.9"] = bench::quantile(all_, 0.999);
        state.counters["touching_p50"] = bench::quantile(touching_, 0.5);
        state.counters["touching_p99"] = bench::quantile(touching_, 0.99);
        state.counters["touching_p99.9"] = bench::quantile(touching_, 0.999);
        state.counters["touching"] = static_cast<double>(touching_.size()) / static_cast<double>(all_.size());
        state.counters["first_max"] = bench::quantile(first_, 1.0);
    }

  private:
    std::vector<double> all_, touching_, first_;  // microseconds
};

// Measures every `every`-th pose. `make_step()` returns a step without cached state; `step(pose)` returns
// whether the tool touches.
template <class MakeStep>
void along(benchmark::State& state, std::size_t every, const MakeStep& make_step) {
    const std::vector<Pose>& sweep = Ground::get().sweep;
    for (auto _ : state) {
        std::vector<double> least(sweep.size(), 1e9);
        std::vector<bool> touches(sweep.size());
        for (int round = 0; round < rounds; ++round) {
            auto step = make_step();
            for (std::size_t i = 0; i < sweep.size(); i += every) {
                const double start = bench::thread_microseconds();
                touches[i] = step(sweep[i]);
                least[i] = std::min(least[i], bench::thread_microseconds() - start);
            }
        }
        Ticks ticks;
        for (std::size_t i = 0; i < sweep.size(); i += every) {
            // Between two segments the tool is placed without a path.
            const bool follows = i > 0 && glm::length(sweep[i].position - sweep[i - 1].position) < 2e-3;
            ticks.add(least[i], touches[i], follows);
        }
        ticks.tell(state);
        state.counters["after_load"] = least[0];
    }
}

std::string triangles(std::size_t casing) {
    std::size_t count = 0;
    for (const collision::ContactMesh& part : Ground::get().casings[casing]) count += part.triangles.size();
    return std::to_string(count) + " triangles";
}

void proximity(benchmark::State& state, const collision::World& world, bool forgetful) {
    guarded(state, [&] {
        const collision::ToolShape& tool = Ground::get().tool;
        along(state, forgetful ? 50 : 1, [&] {
            return [&, known = collision::make_narrow_phase(world, tool)](const Pose& pose) mutable {
                std::array<collision::Contact, 32> contacts;
                if (forgetful) collision::clear_cache(known, world, tool);
                return find_contacts(world, tool, pose, band, known, contacts).count > 0;
            };
        });
        state.SetLabel(triangles(static_cast<std::size_t>(state.range(0))) + ", " +
                       std::to_string(tool.samples.samples.size()) + " samples on the wrench, " +
                       std::to_string(world.shapes[0].samples.samples.size()) + " on the casing");
    });
}
const collision::World& ground(const benchmark::State& state) {
    return Ground::get().worlds[static_cast<std::size_t>(state.range(0))];
}
void contact_proximity(benchmark::State& state) { proximity(state, ground(state), false); }
BENCHMARK(contact_proximity)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);

// Baselines of our own: nothing known from the tick before, and no octree.
void contact_proximity_forgetful(benchmark::State& state) { proximity(state, ground(state), true); }
BENCHMARK(contact_proximity_forgetful)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);
void contact_narrow_phase_without_octree(benchmark::State& state) {
    proximity(state, Ground::get().world(0, 0.0), false);
}
BENCHMARK(contact_narrow_phase_without_octree)->Arg(0)->Iterations(1)->Unit(benchmark::kMillisecond);

// The peer libraries that were found at build time.
void contact_peer(benchmark::State& state, bench::MakePeer make, std::size_t every) {
    guarded(state, [&] {
        const auto casing = static_cast<std::size_t>(state.range(0));
        const std::unique_ptr<bench::Peer> peer = make(Ground::get().casings[casing], Ground::get().wrench);
        along(state, every, [&] { return [&](const Pose& pose) { return peer->touches(pose); }; });
        state.SetLabel(triangles(casing));
    });
}
const bool registered = [] {
    for (const bench::PeerEntry& peer : bench::peers())
        benchmark::RegisterBenchmark(("contact_" + peer.name).c_str(), contact_peer, peer.make, peer.every)
            ->Arg(0)
            ->Arg(1)
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    return true;
}();

}  // namespace
