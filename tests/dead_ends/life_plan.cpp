#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "engine/base/random.hpp"
#include "tests/dead_ends/life.hpp"

namespace dead_ends {

namespace {

constexpr std::size_t max_joints = 3;  // on a large assembly, whose bolts are all alike

// A tick with the hand deep in an obstacle takes a hundred times as long as a free one.
constexpr double among_obstacles = 0.2;
constexpr double longest_in_walls = 4.0;  // s

std::string any_assembly(Random& random) {
    const double which = random.uniform();
    return which < 0.90 ? "cover-m8" : which < 0.96 ? "zq350" : "dn200-pn16";
}

}  // namespace

LifePlan make_life_plan(std::uint64_t seed) {
    Random random(seed, 9100);
    LifePlan p;
    p.seed = seed;
    p.assembly = any_assembly(random);
    if (p.assembly == "zq350" && random.chance(0.5)) p.variant = "stainless";
    p.options.mode = static_cast<lesson::Mode>(seed % 3);
    p.options.task = random.chance(0.3) ? lesson::Task::loosen : lesson::Task::tighten;
    p.options.law = random.chance(0.15) ? joint::Law::published : joint::Law::mechanistic;
    p.options.seed = seed;
    p.options.trainee_profile = "person";
    p.at_mouse = random.chance(0.65);
    p.rough = random.chance(0.3);
    p.overtightens = random.chance(0.25);
    p.span = p.overtightens ? random.uniform(40.0, 150.0) : random.uniform(2.0, p.rough ? 45.0 : 25.0);
    const bool among = random.chance(p.at_mouse ? among_obstacles : 0.5 * among_obstacles);
    p.options.obstacles = among ? session::ObstacleUse::required : session::ObstacleUse::none;
    if (among && !p.at_mouse) p.span = std::min(p.span, longest_in_walls);
    if (random.chance(0.25)) p.tool = "torque_wrench";
    if (random.chance(0.3)) p.set_torque_scale = random.uniform(0.4, 2.5);
    return p;
}

std::string describe(const LifePlan& p) {
    return fmt::format("seed {}: {} {}, {}, {}, {} law, {}, {}{}{}, {:.1f} s", p.seed, p.assembly, p.variant,
                       lesson::name(p.options.mode), lesson::name(p.options.task), joint::name(p.options.law),
                       p.options.obstacles == session::ObstacleUse::none ? "no obstacles" : "obstacles",
                       p.at_mouse ? "mouse" : "device",
                       p.overtightens ? ", overtightens"
                       : p.rough      ? ", rough"
                                      : "",
                       p.tool.empty() ? "" : ", torque wrench", p.span);
}

content::Assembly assembly_of(const LifePlan& p) {
    content::LoadedAssembly loaded = content::load_assembly(p.assembly, p.variant);
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, p.tool));
    std::vector<content::Pass>& passes = loaded.assembly.passes;
    if (passes.front().order.size() <= max_joints + 1) return std::move(loaded.assembly);
    const std::vector<std::size_t> few(passes.front().order.begin(),
                                       passes.front().order.begin() + max_joints);
    for (content::Pass& pass : passes)
        std::erase_if(pass.order, [&](std::size_t joint) {
            return std::find(few.begin(), few.end(), joint) == few.end();
        });
    return std::move(loaded.assembly);
}

}  // namespace dead_ends
