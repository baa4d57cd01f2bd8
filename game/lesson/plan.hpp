// A lesson as a list of steps, made from the assembly's passes.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"

namespace bolt::lesson {

enum class Mode : std::uint8_t { guided, practice, assessment };
enum class Task : std::uint8_t { tighten, loosen };
enum class StepKind : std::uint8_t { run_down, tighten, recheck, loosen };

constexpr std::string_view name(Mode mode) {
    constexpr std::string_view names[] = {"guided", "practice", "assessment"};
    return names[static_cast<int>(mode)];
}

constexpr std::string_view name(Task task) { return task == Task::tighten ? "tighten" : "loosen"; }

constexpr std::string_view name(StepKind kind) {
    constexpr std::string_view names[] = {"run down by hand", "tighten", "re-check", "loosen"};
    return names[static_cast<int>(kind)];
}

struct Step {
    StepKind kind = StepKind::tighten;
    std::size_t joint = 0;
    double torque = 0.0;    // N·m to reach; tighten and recheck
    double fraction = 1.0;  // of the joint's target
    int pass = 0;
};

// An assembly's specifications are those of its mechanistic joints. Under the published law every joint ends
// at the same T_max by turning the last quarter, so targets above 98 % of it come down to that, and no angle
// is judged.
content::Assembly under_law(content::Assembly assembly, joint::Law law);

// Tightening: the assembly's passes in order. Loosening: every joint once, in the reverse of the last pass's
// order.
std::vector<Step> make_plan(const content::Assembly& assembly, Task task);

// Whether a step is work for fingers: a nut that is run down, unless it drags too much for them.
// `finger_torque`: N·m that they can put on it.
bool by_fingers(const content::Assembly& assembly, const Step& step, double finger_torque);

}  // namespace bolt::lesson
