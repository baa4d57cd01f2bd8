#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/assets/gltf.hpp"
#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "engine/base/result.hpp"
#include "haptics/collision/narrow_phase.hpp"
#include "haptics/collision/world.hpp"
#include "tools/bench/contact_peers.hpp"
#include "tools/bench/harness.hpp"

// What contact is measured with: a casing of as many triangles as wanted, the shipped wrench, and a way of
// the wrench near and into the casing.

namespace bolt::bench {

// The meshes of a glTF file where their nodes are, one a node; of those nodes only whose name begins with one
// of `prefixes`, if there are any.
Result<std::vector<collision::ContactMesh>> load_contact(const std::filesystem::path& path,
                                                         const std::vector<std::string>& prefixes = {});

// Every edge longer than `longest` halved until there is none; new vertices lie on waves of 20 µm, so that
// nothing stays flat.
collision::ContactMesh refined(const collision::ContactMesh& mesh, double longest);

// A pose a millisecond: the tool comes to a place on the casing with a point of its own, goes 4 mm before it
// to 8 mm behind it, moves on along it, and goes on to the next, turned anyhow; minimum jerk, no point of it
// faster than 0.3 m/s. Where that leads into the casing it is pushed out again but for `deepest`, as a
// god-object would.
std::vector<Pose> make_sweep(const collision::World& world, const collision::Solid& casing,
                             const collision::ToolShape& tool, double deepest, double seconds);

namespace {

using collision::ContactMesh;

Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}

Vec3 random_point(Random& random, const ContactMesh& mesh, const std::vector<double>& sums, Vec3& normal) {
    const auto above = std::upper_bound(sums.begin(), sums.end(), random.uniform() * sums.back());
    const auto t = std::min(mesh.triangles.size() - 1, static_cast<std::size_t>(above - sums.begin()));
    const auto [a, b, c] = corners(mesh, t);
    normal = Vec3(mesh.face_normals[t]);
    const double u = std::sqrt(random.uniform());
    const double v = random.uniform();
    return a * (1.0 - u) + b * (u * (1.0 - v)) + c * (u * v);
}

std::vector<double> area_sums(const ContactMesh& mesh) {
    std::vector<double> sums;
    double area = 0.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = corners(mesh, t);
        sums.push_back(area += glm::length(glm::cross(b - a, c - a)));
    }
    return sums;
}

}  // namespace

Result<std::vector<ContactMesh>> load_contact(const std::filesystem::path& path,
                                              const std::vector<std::string>& prefixes) {
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

std::vector<Pose> make_sweep(const collision::World& world, const collision::Solid& casing,
                             const collision::ToolShape& tool, double deepest, double seconds) {
    Random random(7);
    const std::vector<double> casing_sums = area_sums(casing.mesh);
    const std::vector<double> tool_sums = area_sums(tool.solid.mesh);
    collision::NarrowPhaseState state = collision::make_narrow_phase(world, tool);
    // Pushes out along the deepest contact repeatedly and returns slowly: nearly the motion of a god-object.
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
        const double length = glm::length(to.position - from.position) + tool.reach() * turn;
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
        Pose there{at + random.uniform(-8e-3, 4e-3) * normal, random_turn(random)};
        there.position -= there.orientation * on_tool;
        // There along the normal, a bit along the surface, and back.
        const Pose before{there.position + 25e-3 * normal, there.orientation};
        const Vec3 along = glm::normalize(glm::cross(normal, Vec3(random.normal(), random.normal(), 0.3)));
        const Pose after{there.position + 15e-3 * along, rotation(0.2 * normal) * there.orientation};
        std::vector<Pose> way;
        shift = Vec3(0.0);
        bool allowed = true;
        for (const auto& [a, b] :
             {std::pair(from, before), std::pair(before, there), std::pair(there, after)}) {
            // Far ways are not the point: the tool is put there.
            if (glm::length(a.position - b.position) > 0.1) continue;
            const std::vector<Pose> part = leg(a, b);
            allowed = allowed && !part.empty();
            way.insert(way.end(), part.begin(), part.end());
        }
        if (!allowed) continue;
        sweep.insert(sweep.end(), way.begin(), way.end());
        from = after;
    }
    return sweep;
}

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

// Contact queries, tick by tick along a path of the wrench near and on the casing. A benchmark iteration is
// the whole path. The counters are microseconds of this thread's CPU time, the least of three rounds for each
// tick. `touching_*`: only ticks with contacts; `after_load`: the first tick.

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
