#include "tools/verify/contact/penetration_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/servo/engagement.hpp"
#include "tools/verify/contact/near_poses.hpp"

namespace bolt::contact_validation {

namespace {

constexpr double mm = 1e-3;
constexpr double sure_from = 50e-6;          // m
constexpr double looked_at_from = 0.2 * mm;  // truth is asked for where the finder has something this near

Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}
Vec3 random_direction(Random& random) { return random_turn(random) * Vec3(1, 0, 0); }

void note(PenetrationRun& run, const Meeting& met, collision::ObstacleId in, const Pose& tool) {
    if (met.crosses) ++run.crossing;
    if (met.depth <= run.depth) return;
    run.depth = met.depth;
    run.in = in;
    run.tool = tool;
}

// Only how deep it is, and only if that is more than was known. Where flat lies on flat, to know it of what
// is hardly inside would take seconds.
Looking deeper_than(const PenetrationRun& run) {
    return {.reach = 0.0, .depths = {.least = std::max(sure_from, run.depth), .tolerance = 10e-6}};
}

class Hand {
  public:
    Hand(const servo::Setup& setup, servo::State& state, const Scene& scene, PenetrationRun& run)
        : setup_(setup), state_(state), scene_(scene), run_(run) {}

    servo::Output step(const Pose& hand, servo::Grip grip = servo::Grip::wrench) {
        servo::Input input;
        input.enabled = true;
        input.grip = grip;
        input.device = servo::sample_of(hand);
        const servo::Output output = servo::tick(setup_, state_, input);
        if (grip == servo::Grip::wrench) look(output.tool);
        return output;
    }
    // In a minimum-jerk motion from where it was left.
    void go(const Pose& to, double seconds) {
        const int ticks = static_cast<int>(seconds / setup_.dt);
        const Pose from = at_;
        for (int i = 1; i <= ticks; ++i) {
            const double t = static_cast<double>(i) / ticks;
            const double s = minimum_jerk(t);
            at_ = {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)};
            step(at_);
        }
    }
    // Put there without a way; nothing may be there.
    void begin(const Pose& at) {
        at_ = at;
        for (int i = 0; i < 3; ++i) step(at_, servo::Grip::none);
    }

  private:
    void look(const Pose& tool) {
        ++run_.ticks;
        const servo::ToolContact& touch = *state_.tool_contact;
        if (touch.last_step.contacts == 0 || touch.last_step.nearest > looked_at_from) return;
        ++run_.touching;
        bool crosses = false;
        for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
            const Part& part = scene_.parts[i];
            Meeting met = meet(scene_, i, inverse(place_of(part, tool)) * tool, deeper_than(run_));
            crosses = crosses || met.crosses;
            met.crosses = false;
            note(run_, met, part.id, tool);
        }
        run_.crossing += crosses ? 1U : 0U;
    }
    [[nodiscard]] Pose place_of(const Part& part, const Pose& tool) const {
        const servo::ToolContact& touch = *state_.tool_contact;
        const Pose place = touch.world.bodies[part.body].pose;
        if (touch.seated_joint < 0 ||
            part.id != collision::ObstacleId::nut(static_cast<std::size_t>(touch.seated_joint)))
            return place;
        const collision::Jaw& jaw = setup_.wrench.jaw;
        const servo::NutGeometry& nut = setup_.nuts[static_cast<std::size_t>(touch.seated_joint)];
        const double play = joint::rounded_half_play(jaw.opening, nut.across_flats, 0.0);
        const double off = collision::seat_of(jaw, servo::prism_of(nut), inverse(place) * tool).misalignment;
        return {place.position,
                place.orientation * glm::angleAxis(std::clamp(off, -play, play) - off, Vec3(0, 0, 1))};
    }

    const servo::Setup& setup_;
    servo::State& state_;
    const Scene& scene_;
    PenetrationRun& run_;
    Pose at_;
};

// Somewhere in the assembly or beside it, 5 mm from everything.
Pose free_place(const servo::ToolContact& touch, const Scene& scene, Random& random) {
    geometry::Box box;
    for (const Part& part : scene.parts) {
        const Pose& place = touch.world.bodies[part.body].pose;
        const geometry::Box own = part.surface.tree.box();
        box.add(place * own.low);
        box.add(place * own.high);
    }
    for (;;) {
        Pose pose{Vec3(0.0), random_turn(random)};
        for (int k = 0; k < 3; ++k) pose.position[k] = random.uniform(box.low[k] - 0.05, box.high[k] + 0.05);
        const Meeting met = meet(scene, touch.world, pose, {.reach = 5 * mm, .depths = {.enough = 0.0}});
        if (!met.crosses && met.gap >= 5 * mm) return pose;
    }
}

// A world of a few boxes, and the god-object in it.
struct Boxes {
    collision::World world;
    const collision::ToolShape& tool;
    const proxy::GodObjectParameters& parameters;
    Scene scene;
    collision::NarrowPhaseState near;

    static Result<Boxes> make(std::span<const geometry::Box> boxes, const collision::ToolShape& tool,
                              const proxy::GodObjectParameters& parameters) {
        std::vector<collision::ContactMesh> meshes;
        for (const geometry::Box& box : boxes) {
            Result<collision::ContactMesh> mesh = mesh_of(box);
            if (!mesh) return fail(mesh.error());
            meshes.push_back(std::move(*mesh));
        }
        std::vector<collision::Obstacle> obstacles;
        for (const collision::ContactMesh& mesh : meshes)
            obstacles.push_back({collision::ObstacleId::fixed(obstacles.size()), &mesh, {}, false});
        Result<collision::World> world = collision::make_world(obstacles);
        if (!world) return fail(world.error());
        Scene scene = make_scene(*world, tool);
        collision::NarrowPhaseState near = collision::make_narrow_phase(*world, tool);
        return Boxes{std::move(*world), tool, parameters, std::move(scene), std::move(near)};
    }
    void step(proxy::GodObjectState& state, const Pose& device, PenetrationRun& run) {
        const proxy::GodObjectStep done = proxy::step_god_object(
            parameters, state, device,
            [&](const Pose& pose, double band, std::span<collision::Contact> out) {
                return collision::find_contacts(world, tool, pose, band, near, out);
            },
            1e-3);
        ++run.ticks;
        if (done.contacts == 0 || done.nearest > looked_at_from) return;
        ++run.touching;
        const Meeting met = meet(scene, world, state.tool, deeper_than(run));
        note(run, met, scene.parts[met.deepest].id, state.tool);
    }

  private:
    static Result<collision::ContactMesh> mesh_of(const geometry::Box& box) {
        std::vector<glm::vec3> vertices;
        for (int i = 0; i < 8; ++i)
            vertices.emplace_back((i & 1) != 0 ? box.high.x : box.low.x,
                                  (i & 2) != 0 ? box.high.y : box.low.y,
                                  (i & 4) != 0 ? box.high.z : box.low.z);
        constexpr std::array<std::uint32_t, 36> sides{0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                                      2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
        return collision::make_contact_mesh(vertices, sides);
    }
};

}  // namespace

PenetrationRun pulled_through(const servo::Setup& setup, servo::State& state, const Scene& scene,
                              std::uint64_t seed, int ways) {
    PenetrationRun run{.name = "pulled through everything"};
    Hand hand(setup, state, scene, run);
    Random random(seed, 5);
    hand.begin(free_place(*state.tool_contact, scene, random));
    for (int i = 0; i < ways; ++i) hand.go(free_place(*state.tool_contact, scene, random), 1.5);
    return run;
}

PenetrationRun at_nuts(const servo::Setup& setup, servo::State& state, const Scene& scene, std::uint64_t seed,
                       int times) {
    PenetrationRun run{.name = "put onto nuts, badly"};
    Hand hand(setup, state, scene, run);
    Random random(seed, 6);
    for (int i = 0; i < times; ++i) {
        const std::size_t joint = random.bits() % setup.nuts.size();
        const servo::NutGeometry& nut = setup.nuts[joint];
        const double angle = state.joints[joint].nut.angle;
        // A free way round, jaw on the flats but for some misfit.
        Pose over;
        const auto above = [&](double height, const Vec3& aside) {
            return servo::nut_centre(nut, angle) + height * nut.axis + aside;
        };
        bool free = false;
        for (int turn = 0; turn < 6 && !free; ++turn) {
            const double handle = angle + setup.wrench.head_angle + turn * pi / 3.0;
            const Vec3 x = std::cos(handle) * nut.e1 - std::sin(handle) * nut.e2;
            over.orientation =
                glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
            over.position = above(35 * mm, Vec3(0.0));
            free = !meet(scene, state.tool_contact->world, over, {.depths = {.enough = 0.0}}).crosses;
        }
        if (!free) continue;
        const Quat misfit = glm::angleAxis(to_radians(random.uniform(-8.0, 8.0)), nut.axis);
        const Quat tilt = rotation(to_radians(random.uniform(0.0, 4.0)) * random_direction(random));
        const Quat turned = glm::normalize(tilt * misfit * over.orientation);
        const Vec3 aside = random.uniform(0.0, 1.5 * mm) * random_direction(random);
        hand.begin(over);
        hand.go({above(random.uniform(-8.0, 3.0) * mm, aside), turned}, 0.5);
        // Home, there turned about, tilted and pulled at, and off by some way.
        const Vec3 home = above(random.uniform(-3.0, 3.0) * mm, Vec3(0.0));
        hand.go({home, over.orientation}, 0.4);
        for (int k = 0; k < 3; ++k) {
            const Quat about = glm::angleAxis(to_radians(random.uniform(-40.0, 40.0)), nut.axis);
            const Quat over_it = rotation(to_radians(random.uniform(0.0, 6.0)) * random_direction(random));
            hand.go({home + random.uniform(0.0, 8.0 * mm) * random_direction(random),
                     glm::normalize(over_it * about * over.orientation)},
                    random.uniform(0.1, 0.5));
        }
        hand.go({above(35 * mm, 10 * mm * random_direction(random)), over.orientation}, 0.3);
    }
    return run;
}

Result<PenetrationRun> flicked(const collision::ToolShape& tool, const proxy::GodObjectParameters& parameters,
                               std::uint64_t seed, int times) {
    PenetrationRun run{.name = "flicked through a rib of 1 mm at 2 m/s"};
    const geometry::Box rib{Vec3(-0.5 * mm, -1.0, -1.0), Vec3(0.5 * mm, 1.0, 1.0)};
    Result<Boxes> boxes = Boxes::make({&rib, 1}, tool, parameters);
    if (!boxes) return fail(boxes.error());
    Random random(seed, 7);
    for (int i = 0; i < times; ++i) {
        const Quat turn = random_turn(random);
        double front = 0.0;  // of the tool towards the rib
        for (const glm::vec3& v : tool.solid.mesh.vertices) front = std::max(front, (turn * Vec3(v)).x);
        const Vec3 start(-front - 1 * mm - random.uniform(0.0, 2 * mm), 0.0, 0.0);
        const Vec3 velocity =
            2.0 * glm::normalize(Vec3(1.0, random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)));
        const Vec3 spin = i % 2 == 0 ? Vec3(0.0) : random.uniform(0.0, 10.0) * random_direction(random);
        proxy::GodObjectState state = proxy::start_god_object({start, turn});
        for (int k = 0; k < 80; ++k) {
            const double t = k * 1e-3;
            boxes->step(state, {start + velocity * t, glm::normalize(rotation(spin * t) * turn)}, run);
        }
        // Behind the rib it is free again, and no crossing tells.
        for (const glm::vec3& v : tool.solid.mesh.vertices)
            if ((state.tool * Vec3(v)).x > 0.5 * mm)
                run.depth = std::max(run.depth, (state.tool * Vec3(v)).x);
    }
    return run;
}

Result<PenetrationRun> in_a_slot(const collision::ToolShape& tool,
                                 const proxy::GodObjectParameters& parameters, double thickness,
                                 std::uint64_t seed, int ticks) {
    PenetrationRun run{.name = "jaw in a slot of 1 mm more than it is thick"};
    const double half = 0.5 * (thickness + 1 * mm);
    const std::array<geometry::Box, 2> plates{
        geometry::Box{Vec3(-0.08, -0.08, half), Vec3(0.0, 0.08, half + 0.02)},
        geometry::Box{Vec3(-0.08, -0.08, -half - 0.02), Vec3(0.0, 0.08, -half)}};
    Result<Boxes> boxes = Boxes::make(plates, tool, parameters);
    if (!boxes) return fail(boxes.error());
    Random random(seed, 8);
    proxy::GodObjectState state = proxy::start_god_object({});
    Pose from, to;
    int left = 0, all = 1;
    for (int i = 0; i < ticks; ++i) {
        if (left == 0) {
            from = to;
            to = {random.uniform(0.0, 15 * mm) * random_direction(random),
                  rotation(random.uniform(0.0, 0.3) * random_direction(random))};
            all = left = 20 + static_cast<int>(glm::length(to.position - from.position) /
                                               random.uniform(0.05, 1.0) * 1e3);
        }
        --left;
        const double s = 1.0 - static_cast<double>(left) / all;
        boxes->step(
            state, {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)},
            run);
    }
    return run;
}

std::string to_text(const PenetrationRun& run) {
    std::string text = fmt::format("{}: {} ticks, {} looked at, {} crossing, deepest {:.1f} um", run.name,
                                   run.ticks, run.touching, run.crossing, 1e6 * run.depth);
    if (!run.in.is_none())
        text += fmt::format(" in {} {}, {}", run.in.is_nut() ? "nut" : "obstacle", run.in.index(),
                            to_text(run.tool));
    return text + "\n";
}

}  // namespace bolt::contact_validation
