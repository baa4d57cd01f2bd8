#include "game/lesson/fastener_names.hpp"

#include <algorithm>

namespace bolt::lesson {

namespace {

bool is_screw(const joint::JointDesign& design) { return design.turned == joint::TurnedPart::head; }

bool is_left_handed(const joint::JointDesign& design) {
    return design.thread_direction == joint::ThreadDirection::left;
}

// The text of a choice about all joints: 0 if none has the property, 1 if all have it, 2 if some have it.
std::size_t choice_of_all(const content::Assembly& assembly, bool (*has)(const joint::JointDesign&)) {
    const auto count = std::count_if(assembly.joints.begin(), assembly.joints.end(),
                                     [has](const auto& joint) { return has(joint.design); });
    if (count == 0) return 0;
    return count == std::ssize(assembly.joints) ? 1 : 2;
}

}  // namespace

std::string_view fastener_name(const joint::JointDesign& design) {
    return is_screw(design) ? "screw" : "nut";
}

std::string_view fastener_name(const content::Assembly& assembly) {
    constexpr std::string_view names[] = {"nut", "screw", "joint"};
    return names[choice_of_all(assembly, is_screw)];
}

words::TextArgument fastener_argument(const joint::JointDesign& design) {
    return {"fastener", words::Choice{is_screw(design) ? 1U : 0U}};
}

words::TextArgument fasteners_argument(const content::Assembly& assembly) {
    return {"fasteners", words::Choice{choice_of_all(assembly, is_screw)}};
}

words::TextArgument thread_argument(const joint::JointDesign& design) {
    return {"thread", words::Choice{is_left_handed(design) ? 1U : 0U}};
}

words::TextArgument threads_argument(const content::Assembly& assembly) {
    return {"threads", words::Choice{choice_of_all(assembly, is_left_handed)}};
}

}  // namespace bolt::lesson
