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

constexpr double min_depth = 50e-6;        // m, smaller depths are not resolved
constexpr double check_within = 0.2 * mm;  // the oracle checks ticks with a contact nearer than this

void record(PenetrationRun& run, const ExactContact& exact, collision::ObstacleId obstacle,
            const Pose& tool) {
    if (exact.crosses) ++run.crossing;
    if (exact.depth <= run.depth) return;
    run.depth = exact.depth;
    run.obstacle = obstacle;
    run.tool = tool;
}

// Searches only for depths above the greatest so far. Where flat faces touch, resolving smaller depths would
// take seconds.
OracleQuery depth_query(const PenetrationRun& run) {
    return {.reach = 0.0, .depths = {.min_depth = std::max(min_depth, run.depth), .tolerance = 10e-6}};
}

// Drives the servo with scripted hand poses and records the penetration of each tick.
class SimulatedHand {
  public:
    SimulatedHand(const servo::Setup& setup, servo::State& state, const ContactScene& scene,
                  PenetrationRun& run)
        : setup_(setup), state_(state), scene_(scene), run_(run) {}

    servo::Output step(const Pose& hand, servo::Grip grip = servo::Grip::wrench) {
        servo::TickInput input;
        input.dead_man = true;
        input.grip = grip;
        input.commanded_tool = servo::to_commanded_tool(hand);
        const servo::Output output = servo::tick(setup_, state_, input);
        if (grip == servo::Grip::wrench) measure(output.constrained_tool);
        return output;
    }
    // Moves the hand from its current pose along a minimum-jerk profile.
    void move_to(const Pose& to, double seconds) {
        const int ticks = static_cast<int>(seconds / setup_.dt);
        const Pose from = at_;
        for (int i = 1; i <= ticks; ++i) {
            const double t = static_cast<double>(i) / ticks;
            const double s = minimum_jerk(t);
            at_ = {glm::mix(from.position, to.position, s), glm::slerp(from.orientation, to.orientation, s)};
            step(at_);
        }
    }
    // Places the hand at a free pose without a motion.
    void place_at(const Pose& at) {
        at_ = at;
        for (int i = 0; i < 3; ++i) step(at_, servo::Grip::none);
    }

  private:
    void measure(const Pose& tool) {
        ++run_.ticks;
        const servo::ToolContact& contact = *state_.tool_contact;
        if (contact.last_step.contacts == 0 || contact.last_step.nearest > check_within) return;
        ++run_.checked;
        bool crosses = false;
        for (std::size_t i = 0; i < scene_.parts.size(); ++i) {
            const ObstaclePart& part = scene_.parts[i];
            ExactContact exact =
                exact_contact(scene_, i, inverse(world_pose_of(part, tool)) * tool, depth_query(run_));
            crosses = crosses || exact.crosses;
            exact.crosses = false;
            record(run_, exact, part.id, tool);
        }
        run_.crossing += crosses ? 1U : 0U;
    }
    // Returns the world pose of a part. The nut in the jaw is turned so that its misalignment stays within
    // the play.
    [[nodiscard]] Pose world_pose_of(const ObstaclePart& part, const Pose& tool) const {
        const servo::ToolContact& contact = *state_.tool_contact;
        const Pose pose_of_body = contact.world.bodies[part.body].pose;
        if (contact.joint_at_head < 0 ||
            part.id != collision::ObstacleId::nut(static_cast<std::size_t>(contact.joint_at_head)))
            return pose_of_body;
        const servo::NutGeometry& nut = setup_.nuts[static_cast<std::size_t>(contact.joint_at_head)];
        const double play = servo::half_play(setup_.wrench, nut.across_flats, 0.0);
        const double off =
            collision::head_fit(setup_.wrench.head, servo::shape_of(nut), inverse(pose_of_body) * tool)
                .misalignment;
        return {pose_of_body.position,
                pose_of_body.orientation * glm::angleAxis(std::clamp(off, -play, play) - off, Vec3(0, 0, 1))};
    }

    const servo::Setup& setup_;
    servo::State& state_;
    const ContactScene& scene_;
    PenetrationRun& run_;
    Pose at_;
};

// Returns a random pose in or beside the assembly, at least 5 mm from every obstacle.
Pose free_pose(const servo::ToolContact& contact, const ContactScene& scene, Random& random) {
    geometry::Aabb box;
    for (const ObstaclePart& part : scene.parts) {
        const Pose& pose_of_body = contact.world.bodies[part.body].pose;
        const geometry::Aabb own = part.surface.tree.box();
        box.add(pose_of_body * own.low);
        box.add(pose_of_body * own.high);
    }
    for (;;) {
        Pose pose{Vec3(0.0), random_turn(random)};
        for (int k = 0; k < 3; ++k) pose.position[k] = random.uniform(box.low[k] - 0.05, box.high[k] + 0.05);
        const ExactContact exact =
            exact_contact(scene, contact.world, pose, {.reach = 5 * mm, .depths = {.stop_depth = 0.0}});
        if (!exact.crosses && exact.gap >= 5 * mm) return pose;
    }
}

// A world of a few boxes with a god-object.
struct BoxWorld {
    collision::CollisionWorld world;
    const collision::ToolShape& tool;
    const proxy::GodObjectParameters& parameters;
    ContactScene scene;
    collision::NarrowPhaseState near;

    static Result<BoxWorld> make(std::span<const geometry::Aabb> boxes, const collision::ToolShape& tool,
                                 const proxy::GodObjectParameters& parameters) {
        std::vector<collision::ContactMesh> meshes;
        for (const geometry::Aabb& box : boxes) {
            Result<collision::ContactMesh> mesh = mesh_of(box);
            if (!mesh) return fail(mesh.error());
            meshes.push_back(std::move(*mesh));
        }
        std::vector<collision::Obstacle> obstacles;
        for (const collision::ContactMesh& mesh : meshes)
            obstacles.push_back({collision::ObstacleId::fixed(obstacles.size()), &mesh, {}, false});
        Result<collision::CollisionWorld> world = collision::make_world(obstacles);
        if (!world) return fail(world.error());
        ContactScene scene = make_scene(*world, tool);
        collision::NarrowPhaseState near = collision::make_narrow_phase(*world, tool);
        return BoxWorld{std::move(*world), tool, parameters, std::move(scene), std::move(near)};
    }
    void step(proxy::GodObjectState& state, const Pose& device, PenetrationRun& run) {
        const proxy::GodObjectStep done = proxy::step_god_object(
            parameters, state, device,
            [&](const Pose& pose, double band, std::span<collision::Contact> out) {
                return collision::find_contacts(world, tool, pose, band, near, out);
            },
            1e-3);
        ++run.ticks;
        if (done.contacts == 0 || done.nearest > check_within) return;
        ++run.checked;
        const ExactContact exact = exact_contact(scene, world, state.constrained_tool, depth_query(run));
        record(run, exact, scene.parts[exact.deepest].id, state.constrained_tool);
    }

  private:
    static Result<collision::ContactMesh> mesh_of(const geometry::Aabb& box) {
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

PenetrationRun run_through_obstacles(const servo::Setup& setup, servo::State& state,
                                     const ContactScene& scene, std::uint64_t seed, int motions) {
    PenetrationRun run{.name = "pulled through obstacles"};
    SimulatedHand hand(setup, state, scene, run);
    Random random(seed, 5);
    hand.place_at(free_pose(*state.tool_contact, scene, random));
    for (int i = 0; i < motions; ++i) hand.move_to(free_pose(*state.tool_contact, scene, random), 1.5);
    return run;
}

PenetrationRun run_onto_nuts(const servo::Setup& setup, servo::State& state, const ContactScene& scene,
                             std::uint64_t seed, int times) {
    PenetrationRun run{.name = "put onto nuts, misaligned"};
    SimulatedHand hand(setup, state, scene, run);
    Random random(seed, 6);
    for (int i = 0; i < times; ++i) {
        const std::size_t joint = random.bits() % setup.nuts.size();
        const servo::NutGeometry& nut = setup.nuts[joint];
        const double angle = state.joints[joint].nut.angle;
        // Try the six orientations of the jaw on the flats until the handle is free.
        Pose over;
        const auto above = [&](double height, const Vec3& aside) {
            return servo::nut_centre(nut, angle) + height * nut.axis + aside;
        };
        bool free = false;
        for (int turn = 0; turn < 6 && !free; ++turn) {
            const double handle = angle + nut.sense * setup.wrench.head_angle + turn * pi / 3.0;
            const Vec3 x = servo::direction_at(nut, handle);
            over.orientation =
                glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
            over.position = above(35 * mm, Vec3(0.0));
            free = !exact_contact(scene, state.tool_contact->world, over, {.depths = {.stop_depth = 0.0}})
                        .crosses;
        }
        if (!free) continue;
        const Quat misfit = glm::angleAxis(to_radians(random.uniform(-8.0, 8.0)), nut.axis);
        const Quat tilt = rotation(to_radians(random.uniform(0.0, 4.0)) * random_direction(random));
        const Quat turned = glm::normalize(tilt * misfit * over.orientation);
        const Vec3 aside = random.uniform(0.0, 1.5 * mm) * random_direction(random);
        hand.place_at(over);
        hand.move_to({above(random.uniform(-8.0, 3.0) * mm, aside), turned}, 0.5);
        // Seat the jaw, then turn, tilt and pull it there, and lift it off.
        const Vec3 home = above(random.uniform(-3.0, 3.0) * mm, Vec3(0.0));
        hand.move_to({home, over.orientation}, 0.4);
        for (int k = 0; k < 3; ++k) {
            const Quat about = glm::angleAxis(to_radians(random.uniform(-40.0, 40.0)), nut.axis);
            const Quat over_it = rotation(to_radians(random.uniform(0.0, 6.0)) * random_direction(random));
            hand.move_to({home + random.uniform(0.0, 8.0 * mm) * random_direction(random),
                          glm::normalize(over_it * about * over.orientation)},
                         random.uniform(0.1, 0.5));
        }
        hand.move_to({above(35 * mm, 10 * mm * random_direction(random)), over.orientation}, 0.3);
    }
    return run;
}

Result<PenetrationRun> run_flicks(const collision::ToolShape& tool,
                                  const proxy::GodObjectParameters& parameters, std::uint64_t seed,
                                  int times) {
    PenetrationRun run{.name = "flicked through a rib of 1 mm at 2 m/s"};
    const geometry::Aabb rib{Vec3(-0.5 * mm, -1.0, -1.0), Vec3(0.5 * mm, 1.0, 1.0)};
    Result<BoxWorld> boxes = BoxWorld::make({&rib, 1}, tool, parameters);
    if (!boxes) return fail(boxes.error());
    Random random(seed, 7);
    for (int i = 0; i < times; ++i) {
        const Quat turn = random_turn(random);
        double front = 0.0;  // m, extent of the tool towards the rib
        for (const glm::vec3& v : tool.solid.mesh.vertices) front = std::max(front, (turn * Vec3(v)).x);
        const Vec3 start(-front - 1 * mm - random.uniform(0.0, 2 * mm), 0.0, 0.0);
        const double z = random.uniform(-1.0, 1.0);
        const double y = random.uniform(-1.0, 1.0);
        const Vec3 velocity = 2.0 * glm::normalize(Vec3(1.0, y, z));
        const Vec3 spin = i % 2 == 0 ? Vec3(0.0) : random.uniform(0.0, 10.0) * random_direction(random);
        proxy::GodObjectState state = proxy::start_god_object({start, turn});
        for (int k = 0; k < 80; ++k) {
            const double t = k * 1e-3;
            boxes->step(state, {start + velocity * t, glm::normalize(rotation(spin * t) * turn)}, run);
        }
        // A tool that has passed the rib no longer crosses it, so check the side as well.
        for (const glm::vec3& v : tool.solid.mesh.vertices)
            if ((state.constrained_tool * Vec3(v)).x > 0.5 * mm)
                run.depth = std::max(run.depth, (state.constrained_tool * Vec3(v)).x);
    }
    return run;
}

Result<PenetrationRun> run_in_slot(const collision::ToolShape& tool,
                                   const proxy::GodObjectParameters& parameters, double thickness,
                                   std::uint64_t seed, int ticks) {
    PenetrationRun run{.name = "jaw in a slot of 1 mm more than it is thick"};
    const double half = 0.5 * (thickness + 1 * mm);
    const std::array<geometry::Aabb, 2> plates{
        geometry::Aabb{Vec3(-0.08, -0.08, half), Vec3(0.0, 0.08, half + 0.02)},
        geometry::Aabb{Vec3(-0.08, -0.08, -half - 0.02), Vec3(0.0, 0.08, -half)}};
    Result<BoxWorld> boxes = BoxWorld::make(plates, tool, parameters);
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
    std::string text = fmt::format("{}: {} ticks, {} checked, {} crossing, greatest depth {:.1f} um",
                                   run.name, run.ticks, run.checked, run.crossing, 1e6 * run.depth);
    if (!run.obstacle.is_none())
        text += fmt::format(" in {} {}, {}", run.obstacle.is_nut() ? "nut" : "obstacle", run.obstacle.index(),
                            to_text(run.tool));
    return text + "\n";
}

}  // namespace bolt::contact_validation
