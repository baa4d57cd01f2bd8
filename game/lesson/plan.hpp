// Plans a lesson: a list of steps, made from the assembly's passes.
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

// The assembly with `law` in force, its specifications adapted to it. The specifications of joint types hold
// under the mechanistic law. Under the published law every joint ends at the same T_max, whatever its
// fastener is: the assembly's own published targets replace them; without any, targets above 98 % of T_max
// are lowered to that. No angle is judged, and the target clamp force follows from the target torque.
// Applying a law twice changes nothing more.
content::Assembly under_law(content::Assembly assembly, joint::Law law);

// Tightening: the assembly's passes in order. Loosening: every joint once, in the reverse of the last pass's
// order.
std::vector<Step> make_plan(const content::Assembly& assembly, Task task);

// Whether fingers do the step: running down a nut whose drag is small against `finger_torque`, the torque
// that fingers can apply, N·m.
bool by_fingers(const content::Assembly& assembly, const Step& step, double finger_torque);

}  // namespace bolt::lesson
