// The steps of a lesson, planned from the passes of the assembly. A pass is a sequence of steps over all
// joints, such as: tighten all nuts to half of the target torque.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/enum_names.hpp"
#include "game/lesson/result.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::lesson {

enum class StepKind : std::uint8_t { run_down, tighten, turn, recheck, loosen };

inline constexpr EnumNames<StepKind, 5> step_kind_names{
    {"run down by hand", "tighten", "turn", "re-check", "loosen"}};
constexpr std::string_view name(StepKind kind) { return step_kind_names.of(kind); }

struct LessonStep {
    StepKind kind = StepKind::tighten;
    std::size_t joint = 0;
    // N·m, torque at the nut, with `fraction` already applied. Steps `tighten` and `recheck` end there; other
    // steps do not.
    double torque = 0.0;
    double fraction = 1.0;  // tighten: of the joint's target torque; turn: of its target angle
    int pass = 0;
    // rad. turn: the angle to reach, counted from the mark (docs/glossary.md). loosen: the angle to turn
    // back; 0: until the nut is free.
    double angle = 0.0;
    // N·m on the scale of the torque wrench (content::adaptor_ratio); 0 for other tools and for steps that do
    // not end at a torque.
    double set_torque = 0.0;
};

// The passes of a loosening lesson: those of the assembly file. If it has none, one pass that loosens every
// joint, in the reverse order of the last tightening pass.
std::vector<content::Pass> loosening_passes(const content::Assembly& assembly);

// The steps of a lesson, from the passes in their order.
std::vector<LessonStep> make_plan(const content::Assembly& assembly, Task task);

// True if a pass turns the joints by an angle; the angle of each joint then counts from a mark.
bool turns_by_angle(const content::Assembly& assembly);

// True if the step is done by fingers: it runs down a nut whose drag at `nut_angle` (rad) is small compared
// with the torque that fingers can apply. A locking nut is run down by fingers until the bolt's end reaches
// its insert, and then by the tool.
bool uses_fingers(const content::Assembly& assembly, const servo::Setup& setup, const LessonStep& step,
                  double nut_angle);

// The angle window of a step of kind `turn`, rad from the mark: the joint's window times the step's fraction.
content::ToleranceWindow angle_window(const content::Assembly& assembly, const LessonStep& step);

}  // namespace bolt::lesson
