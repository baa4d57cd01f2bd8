#include "game/lesson/fastener_names.hpp"

#include <algorithm>

namespace bolt::lesson {

namespace {

// In the order of the texts of {fasteners: ...}.
enum class TurnedFasteners : std::uint8_t { nuts, screws, both };

bool is_screw(const joint::JointDesign& design) { return design.turned == joint::TurnedPart::head; }

TurnedFasteners fasteners_of(const content::Assembly& assembly) {
    const auto screws = std::count_if(assembly.joints.begin(), assembly.joints.end(),
                                      [](const auto& joint) { return is_screw(joint.design); });
    if (screws == 0) return TurnedFasteners::nuts;
    return screws == std::ssize(assembly.joints) ? TurnedFasteners::screws : TurnedFasteners::both;
}

}  // namespace

std::string_view fastener_name(const joint::JointDesign& design) {
    return is_screw(design) ? "screw" : "nut";
}

std::string_view fastener_name(const content::Assembly& assembly) {
    constexpr std::string_view names[] = {"nut", "screw", "joint"};
    return names[static_cast<std::size_t>(fasteners_of(assembly))];
}

words::TextArgument fastener_argument(const joint::JointDesign& design) {
    return {"fastener", words::Choice{is_screw(design) ? 1U : 0U}};
}

words::TextArgument fasteners_argument(const content::Assembly& assembly) {
    return {"fasteners", words::Choice{static_cast<std::size_t>(fasteners_of(assembly))}};
}

}  // namespace bolt::lesson
