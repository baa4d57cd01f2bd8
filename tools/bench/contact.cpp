// Benchmarks of contact queries, tick by tick along a path of the shipped wrench near and on a casing. One
// benchmark iteration is the whole path. The counters are microseconds of this thread's CPU time; the time of
// a tick is the shortest of three rounds. `touching_*`: ticks with contacts only; `first_max`: the slowest
// tick at the start or after a jump of the path; `after_load`: the first tick.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "engine/base/result.hpp"
#include "haptics/collision/narrow_phase.hpp"
#include "haptics/collision/world.hpp"
#include "tools/bench/contact_peers.hpp"
#include "tools/bench/harness.hpp"

namespace bolt::bench {

namespace {

using collision::ContactMesh;

Vec3 random_point(Random& random, const ContactMesh& mesh, const std::vector<double>& sums, Vec3& normal) {
    const auto above = std::upper_bound(sums.begin(), sums.end(), random.uniform() * sums.back());
    const auto t = std::min(mesh.triangles.size() - 1, static_cast<std::size_t>(above - sums.begin()));
    const auto [a, b, c] = corners(mesh, t);
    normal = Vec3(mesh.face_normals[t]);
    const double u = std::sqrt(random.uniform());
    const double v = random.uniform();
    return a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v);
}

// Returns the running sums of twice the triangles' areas.
std::vector<double> area_sums(const ContactMesh& mesh) {
    std::vector<double> sums;
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners(mesh, t);
        sums.push_back(area += glm::length(glm::cross(b - a, c - a)));
    }
    return sums;
}

// Returns one mesh, in the world frame, for each node with a mesh whose name begins with one of `prefixes`;
// without prefixes for every node with a mesh.
Result<std::vector<ContactMesh>> load_contact(const std::filesystem::path& path,
                                              const std::vector<std::string>& prefixes = {}) {
    BOLT_TRY_ASSIGN(const auto model, assets::read_gltf(path));
    const std::vector<glm::mat4> world = assets::world_transforms(model);
    std::vector<ContactMesh> parts;
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
        const assets::Node& node = model.nodes[n];
        const auto named = [&](const std::string& prefix) { return node.name.starts_with(prefix); };
        if (node.mesh < 0 || (!prefixes.empty() && std::none_of(prefixes.begin(), prefixes.end(), named)))
            continue;
        std::vector<glm::vec3> vertices;
        std::vector<std::uint32_t> indices;
        for (const assets::Primitive& primitive :
             model.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            const auto first = static_cast<std::uint32_t>(vertices.size());
            for (const glm::vec3& v : primitive.positions)
                vertices.emplace_back(glm::dmat4(world[n]) * glm::dvec4(v, 1.0));
            for (const std::uint32_t i : assets::triangle_indices(primitive)) indices.push_back(first + i);
        }
        BOLT_TRY_ASSIGN(auto mesh, collision::make_contact_mesh(vertices, indices));
        parts.push_back(std::move(mesh));
    }
    return parts;
}

// Halves edges until none is longer than `longest` (m). New vertices are displaced by waves of 20 µm so that
// no region stays flat.
ContactMesh refined(const ContactMesh& mesh, double longest) {
    std::vector<glm::vec3> vertices = mesh.vertices;
    std::vector<glm::vec3> normals = mesh.vertex_normals;
    auto triangles = mesh.triangles;
    for (bool again = true; again;) {
        again = false;
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> halves;
        const auto half = [&](std::uint32_t a, std::uint32_t b) -> std::uint32_t {
            if (glm::length(Vec3(vertices[a]) - Vec3(vertices[b])) <= longest) return 0xffffffffU;
            const auto [at, is_new] =
                halves.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(vertices.size()));
            if (is_new) {
                const glm::vec3 normal = glm::normalize(normals[a] + normals[b] + glm::vec3(1e-12F));
                vertices.push_back(0.5F * (vertices[a] + vertices[b]));
                normals.push_back(normal);
            }
            return at->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& t : triangles) {
            std::array<std::uint32_t, 3> m{};
            std::size_t count = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                m[i] = half(t[i], t[(i + 1) % 3]);
                count += m[i] != 0xffffffffU ? 1U : 0U;
            }
            if (count == 0) {
                finer.push_back(t);
                continue;
            }
            again = true;
            std::size_t i = 0;  // the first edge of the pattern
            if (count == 1)
                while (m[i] == 0xffffffffU) ++i;
            if (count == 2)
                while (m[(i + 2) % 3] != 0xffffffffU) ++i;
            const std::uint32_t a = t[i % 3];
            const std::uint32_t b = t[(i + 1) % 3];
            const std::uint32_t c = t[(i + 2) % 3];
            const std::uint32_t ab = m[i % 3];
            const std::uint32_t bc = m[(i + 1) % 3];
            const std::uint32_t ca = m[(i + 2) % 3];
            if (count == 1) {
                finer.insert(finer.end(), {{a, ab, c}, {ab, b, c}});
            } else if (count == 2) {
                finer.insert(finer.end(), {{ab, b, bc}, {a, ab, bc}, {a, bc, c}});
            } else {
                finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
            }
        }
        triangles = std::move(finer);
    }
    for (std::size_t v = mesh.vertices.size(); v < vertices.size(); ++v) {
        const Vec3 waves = Vec3(vertices[v]) * (2.0 * pi / 20e-3);
        const double shift = 20e-6 * std::sin(waves.x) * std::sin(waves.y + 1.0) * std::sin(waves.z + 2.0);
        vertices[v] += static_cast<float>(shift) * normals[v];
    }
    std::vector<std::uint32_t> indices;
    for (const auto& t : triangles) indices.insert(indices.end(), t.begin(), t.end());
    return collision::make_contact_mesh(vertices, indices).value();
}

// Returns one pose per millisecond. In each segment of the path a random point of the tool, in a random
// orientation, approaches a random point of the casing, moves to between 4 mm before and 8 mm behind the
// surface, and slides along it. The profile is minimum jerk; no point of the tool is faster than 0.3 m/s.
// Poses that penetrate the casing by more than `deepest` (m) are pushed out, as a god-object would.
std::vector<Pose> make_sweep(const collision::CollisionWorld& world, const collision::Solid& casing,
                             const collision::ToolShape& tool, double deepest, double seconds) {
    Random random(7);
    const std::vector<double> casing_sums = area_sums(casing.mesh);
    const std::vector<double> tool_sums = area_sums(tool.solid.mesh);
    collision::NarrowPhaseState state = collision::make_narrow_phase(world, tool);
    // Push out along the deepest contact repeatedly and let the shift decay slowly. This approximates the
    // motion of a god-object.
    Vec3 shift(0.0);
    const auto put = [&](Pose pose) -> std::optional<Pose> {
        shift *= 0.98;
        pose.position += shift;
        for (int i = 0; i < 60; ++i) {
            std::array<collision::Contact, 32> contacts;
            const collision::ContactQueryResult found =
                find_contacts(world, tool, pose, 1e-4, state, contacts);
            if (found.count == 0 || contacts[0].distance >= -deepest) return pose;
            const Vec3 out = (-contacts[0].distance - 0.5 * deepest) * contacts[0].normal;
            shift += out;
            pose.position += out;
            if (glm::length(shift) > 12e-3) break;
        }
        return std::nullopt;
    };
    const auto leg = [&](const Pose& from, const Pose& to) {
        std::vector<Pose> poses;
        // No point of the tool is faster than 0.3 m/s.
        const double turn = glm::length(rotation_vector(glm::conjugate(from.orientation) * to.orientation));
        const double length = glm::length(to.position - from.position) + tool.origin_radius() * turn;
        const int steps = 1 + static_cast<int>(1e3 * std::max(0.2, 1.875 * length / 0.3));
        for (int i = 0; i < steps; ++i) {
            const double t = static_cast<double>(i) / steps;
            const double s = minimum_jerk(t);
            const std::optional<Pose> placed = put(
                {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)});
            if (!placed) return std::vector<Pose>{};
            poses.push_back(*placed);
        }
        return poses;
    };
    std::vector<Pose> sweep;
    Pose from{casing.middle + Vec3(0.0, 2.0 * casing.radius, 0.0), Quat(1.0, 0.0, 0.0, 0.0)};
    while (static_cast<double>(sweep.size()) < 1e3 * seconds) {
        Vec3 normal(0.0);
        Vec3 tool_normal(0.0);
        const Vec3 at = random_point(random, casing.mesh, casing_sums, normal);
        const Vec3 on_tool = random_point(random, tool.solid.mesh, tool_sums, tool_normal);
        Pose target{at + random.uniform(-8e-3, 4e-3) * normal, random_turn(random)};
        target.position -= target.orientation * on_tool;
        // Approach along the normal, then slide along the surface.
        const Pose before{target.position + 25e-3 * normal, target.orientation};
        const Vec3 along = glm::normalize(glm::cross(normal, Vec3(random.normal(), random.normal(), 0.3)));
        const Pose after{target.position + 15e-3 * along, rotation(0.2 * normal) * target.orientation};
        std::vector<Pose> segment;
        shift = Vec3(0.0);
        bool allowed = true;
        for (const auto& [a, b] :
             {std::pair(from, before), std::pair(before, target), std::pair(target, after)}) {
            // Skip long transfers: place the tool at their end.
            if (glm::length(a.position - b.position) > 0.1) continue;
            const std::vector<Pose> part = leg(a, b);
            allowed = allowed && !part.empty();
            segment.insert(segment.end(), part.begin(), part.end());
        }
        if (!allowed) continue;
        sweep.insert(sweep.end(), segment.begin(), segment.end());
        from = after;
    }
    return sweep;
}

}  // namespace

std::vector<PeerEntry> peers() {
    return {
#ifdef BOLT_FCL
        {"fcl", make_fcl, 10},
#endif
#ifdef BOLT_BULLET
        {"bullet", make_bullet, 1000},
#endif
    };
}

}  // namespace bolt::bench

namespace {

using namespace bolt;
using bench::run_or_skip;
using bench::unwrap;

constexpr double band = 0.6e-3;
constexpr double edge_for_a_million_triangles = 8.5e-3;  // m: the longest edge for about a million triangles

constexpr double path_seconds = 24.0;  // s, duration of the path
constexpr int path_rounds = 3;         // the shortest time of each tick is used

// The benchmark's argument selects the casing: 0 as shipped (about 60,000 triangles), 1 refined.
struct ContactScenario {
    std::array<std::vector<collision::ContactMesh>, 2> casings;
    std::array<collision::CollisionWorld, 2> worlds;
    std::vector<collision::ContactMesh> wrench;
    collision::ToolShape tool;
    std::vector<Pose> sweep;

    static const ContactScenario& get() {
        static const ContactScenario scenario;
        return scenario;
    }
    [[nodiscard]] collision::CollisionWorld world(std::size_t casing, double cell) const {
        std::vector<collision::Obstacle> obstacles;
        for (const collision::ContactMesh& part : casings[casing])
            obstacles.push_back({collision::ObstacleId::fixed(obstacles.size()), &part, {}, false});
        return unwrap(collision::make_world(obstacles, {cell}));
    }

  private:
    ContactScenario() {
        casings[0] = unwrap(bench::load_contact(
            content::content_folder() / "assemblies/zq350/zq350.contact.glb", {"casing_", "wheel_"}));
        for (const collision::ContactMesh& part : casings[0])
            casings[1].push_back(bench::refined(part, edge_for_a_million_triangles));
        for (std::size_t i = 0; i < worlds.size(); ++i) worlds[i] = world(i, collision::WorldOptions{}.cell);
        wrench = unwrap(bench::load_contact(content::content_folder() / "tools/wrench-24.contact.glb"));
        tool = unwrap(collision::make_tool(wrench));
        sweep = bench::make_sweep(worlds[0], worlds[0].shapes[0].solid, tool, 0.1e-3, path_seconds);
    }
};

// Times of the ticks of a path: all, those in which the tool touches, and the first ticks after a jump, which
// the others exclude.
class TickTimes {
  public:
    void add(double took, bool touches, bool continues) {
        if (!continues) return first_.push_back(took);
        all_.push_back(took);
        if (touches) touching_.push_back(took);
    }
    void report(benchmark::State& state) {
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
void measure_path(benchmark::State& state, std::size_t every, const MakeStep& make_step) {
    const std::vector<Pose>& sweep = ContactScenario::get().sweep;
    for (auto _ : state) {
        std::vector<double> least(sweep.size(), 1e9);
        std::vector<bool> touches(sweep.size());
        for (int round = 0; round < path_rounds; ++round) {
            auto step = make_step();
            for (std::size_t i = 0; i < sweep.size(); i += every) {
                const double start = bench::thread_microseconds();
                touches[i] = step(sweep[i]);
                least[i] = std::min(least[i], bench::thread_microseconds() - start);
            }
        }
        TickTimes times;
        for (std::size_t i = 0; i < sweep.size(); i += every) {
            // The path jumps between two segments.
            const bool continues = i > 0 && glm::length(sweep[i].position - sweep[i - 1].position) < 2e-3;
            times.add(least[i], touches[i], continues);
        }
        times.report(state);
        state.counters["after_load"] = least[0];
    }
}

std::string triangles(std::size_t casing) {
    std::size_t count = 0;
    for (const collision::ContactMesh& part : ContactScenario::get().casings[casing])
        count += part.triangles.size();
    return std::to_string(count) + " triangles";
}

void measure_narrow_phase(benchmark::State& state, const collision::CollisionWorld& world, bool uncached) {
    run_or_skip(state, [&] {
        const collision::ToolShape& tool = ContactScenario::get().tool;
        measure_path(state, uncached ? 50 : 1, [&] {
            return [&, known = collision::make_narrow_phase(world, tool)](const Pose& pose) mutable {
                std::array<collision::Contact, 32> contacts;
                if (uncached) collision::clear_cache(known, world, tool);
                return find_contacts(world, tool, pose, band, known, contacts).count > 0;
            };
        });
        state.SetLabel(triangles(static_cast<std::size_t>(state.range(0))) + ", " +
                       std::to_string(tool.samples.samples.size()) + " samples on the wrench, " +
                       std::to_string(world.shapes[0].samples.samples.size()) + " on the casing");
    });
}
const collision::CollisionWorld& scenario(const benchmark::State& state) {
    return ContactScenario::get().worlds[static_cast<std::size_t>(state.range(0))];
}
void contact_narrow_phase(benchmark::State& state) { measure_narrow_phase(state, scenario(state), false); }
BENCHMARK(contact_narrow_phase)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);

// Our own baselines: without the cache of the previous tick, and without the octree.
void contact_narrow_phase_uncached(benchmark::State& state) {
    measure_narrow_phase(state, scenario(state), true);
}
BENCHMARK(contact_narrow_phase_uncached)->Arg(0)->Arg(1)->Iterations(1)->Unit(benchmark::kMillisecond);
void contact_narrow_phase_without_octree(benchmark::State& state) {
    measure_narrow_phase(state, ContactScenario::get().world(0, 0.0), false);
}
BENCHMARK(contact_narrow_phase_without_octree)->Arg(0)->Iterations(1)->Unit(benchmark::kMillisecond);

// The peer libraries that were found at build time.
void contact_peer(benchmark::State& state, bench::MakePeer make, std::size_t every) {
    run_or_skip(state, [&] {
        const auto casing = static_cast<std::size_t>(state.range(0));
        const std::unique_ptr<bench::Peer> peer =
            make(ContactScenario::get().casings[casing], ContactScenario::get().wrench);
        measure_path(state, every, [&] { return [&](const Pose& pose) { return peer->touches(pose); }; });
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
