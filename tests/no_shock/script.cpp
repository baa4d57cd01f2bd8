#include "tests/no_shock/script.hpp"

#include <array>
#include <cmath>

#include "tests/proxy/support.hpp"

namespace bolt::test {

namespace {

Script script(const std::string& name, std::vector<Obstacle> obstacles, std::vector<Vec3> way,
              const Vec3& turn = Vec3(0.0)) {
    Script s;
    s.name = name;
    add_wrench(s.scene);
    s.way = std::move(way);
    s.turn = turn;
    for (const Obstacle& obstacle : obstacles) {
        const std::size_t first = s.scene.pins.size();
        if (const Box* box = std::get_if<Box>(&obstacle)) add_edges_as_pins(s.scene, *box, 0.002);
        if (const Rod* rod = std::get_if<Rod>(&obstacle)) s.scene.pins.push_back({rod->b, rod->radius});
        for (std::size_t i = first; i < s.scene.pins.size(); ++i)
            s.scene.pins[i].obstacle =
                collision::ObstacleId::fixed(static_cast<std::size_t>(&obstacle - obstacles.data()));
    }
    s.scene.obstacles = std::move(obstacles);
    return s;
}

Vec3 mm(double x, double y, double z) { return 1e-3 * Vec3(x, y, z); }

}  // namespace

// The wrench lies in its own x–y plane: the handle at x = 20 … 160 mm is 8 mm thick, the jaw around the
// origin 10 mm.
std::vector<Script> collisions() {
    const HalfSpace floor{Vec3(0, 0, 1), 0.0};
    std::vector<Script> all;
    all.push_back(script("face, flat", {floor}, {mm(0, 0, 15), mm(0, 0, 0), mm(30, 20, 0), mm(30, 20, 15)}));
    all.push_back(script("face, corner of the jaw first", {floor},
                         {mm(0, 0, 25), mm(0, 0, 6), mm(30, 20, 6), mm(30, 20, 25)}, Vec3(0.3, -0.25, 0.0)));
    all.push_back(script("over an edge and off it", {Box{placed(mm(50, 0, -20)), mm(100, 30, 20)}},
                         {mm(0, 0, 15), mm(0, 0, 0), mm(0, 80, 0)}));
    all.push_back(script("inner corner", {floor, HalfSpace{glm::normalize(Vec3(0, -1, 0.2)), -0.03}},
                         {mm(0, 0, 15), mm(0, 0, 1), mm(0, 18, 1), mm(40, 18, 1), mm(40, 0, 20)}));
    all.push_back(script("outer corner under the handle",
                         {Box{Pose{mm(90, 0, -30), rotation(Vec3(0.6, -0.7, 0.2))}, mm(20, 20, 20)}},
                         {mm(0, 0, 25), mm(0, 0, -2), mm(-40, 15, -2), mm(-40, -25, -2), mm(0, 0, 25)}));
    std::vector<Obstacle> row{HalfSpace{Vec3(0, 0, 1), -0.04}};
    for (int i = 0; i < 4; ++i) row.push_back(Rod{mm(90, 30 * i, -40), mm(90, 30 * i, -8), 0.008});
    all.push_back(
        script("a row of bolt ends", row, {mm(0, -40, 12), mm(0, -40, -1), mm(0, 125, -1), mm(0, 125, 20)}));
    all.push_back(script("a rib of 1 mm", {Box{placed(mm(80, 0, -10)), mm(100, 0.5, 15)}},
                         {mm(0, -60, -2), mm(0, -10, -2), mm(0, -60, -2)}));
    return all;
}

std::vector<Pose> device_poses(const Script& script, double speed, double dt) {
    std::vector<Pose> poses;
    const Quat orientation = rotation(script.turn);
    for (std::size_t leg = 1; leg < script.way.size(); ++leg) {
        const Vec3 from = script.way[leg - 1], to = script.way[leg];
        const int ticks = std::max(1, static_cast<int>(std::ceil(glm::length(to - from) / (speed * dt))));
        for (int i = leg == 1 ? 0 : 1; i <= ticks; ++i)
            poses.push_back({glm::mix(from, to, static_cast<double>(i) / ticks), orientation});
    }
    return poses;
}

Run with_god_object(const GodObjectParameters& parameters, const Script& script, double speed, double dt) {
    Run run;
    const std::vector<Pose> poses = device_poses(script, speed, dt);
    GodObjectState state = start_god_object(poses[0]);
    for (const Pose& device : poses) {
        step_god_object(parameters, state, device, script.scene, dt);
        run.push_back({device.position, state.rendered});
    }
    return run;
}

Run with_penalty(const proxy::Coupling& coupling, const Script& script, double speed, double dt,
                 Penalty which) {
    Run run;
    std::array<Contact, 1024> contacts;
    proxy::Coupling bounded = coupling;
    bounded.stiffness = bounded.torsion = 1.0;
    bounded.damping = bounded.torsion_damping = 0.0;
    for (const Pose& device : device_poses(script, speed, dt)) {
        const ContactQueryResult found = script.scene(device, 1e-6, contacts);
        proxy::Offset sum;
        std::uint64_t bodies = 0;  // one bit per obstacle; contacts are sorted, the deepest first
        for (std::size_t i = 0; i < found.count; ++i) {
            const Contact& c = contacts[i];
            const std::uint64_t body = std::uint64_t{1} << c.obstacle.index();
            if (which == Penalty::deepest && (bodies & body) != 0) continue;
            bodies |= body;
            const Vec3 force = coupling.stiffness * std::max(0.0, -c.distance) * c.normal;
            sum.linear += force;
            sum.angular += glm::cross(c.on_tool - device.position, force);
        }
        run.push_back({device.position, proxy::coupling_force(bounded, sum, sum, dt)});
    }
    return run;
}

Shock shock_of(const Run& run, const proxy::Coupling& c, double dt) {
    Shock shock;
    const auto apart = static_cast<std::size_t>(std::lround(1e-3 / dt));
    for (std::size_t i = apart; i < run.size(); ++i) {
        const Felt &now = run[i], &then = run[i - apart];
        const double before = glm::length(then.command.force);
        const double change = glm::length(now.command.force - then.command.force);
        double own = 0.0;
        for (std::size_t k = i - apart + 1; k <= i; ++k)
            own += c.stiffness * glm::length(run[k].device - run[k - 1].device);
        own += c.damping / dt * glm::length(now.device - run[i - 1].device);
        shock.step = std::max(shock.step, change / c.max_force);
        shock.torque_step =
            std::max(shock.torque_step, glm::length(now.command.torque - then.command.torque) / c.max_torque);
        if (before > 0.1 * c.max_force) shock.event = std::max(shock.event, (change - own) / before);
    }
    return shock;
}

}  // namespace bolt::test
