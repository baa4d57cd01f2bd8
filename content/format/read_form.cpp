// The form of a joint: through-bolt, screw in a tapped hole, or stud; head, turned part, direction of the
// thread, locking nut.
#include <fmt/format.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "content/format/read_joints.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/tapped_thread.hpp"

namespace bolt::content {

namespace {

// A built-in material, of which each value can be replaced, or one whose values are all given.
joint::TappedMaterial read_tapped_material(const LayeredObject& layers) {
    JsonReader& reader = layers.reader();
    // A layer that names a material hides the values of the layers below it.
    std::vector<JsonNode> objects;
    for (const JsonNode& object : layers.objects()) {
        objects.push_back(object);
        if (reader.member(object, "material")) break;
    }
    const LayeredObject hole(reader, std::move(objects));
    const auto name = hole.text("material");
    const auto E = hole.number("E_GPa"), strength = hole.number("tensile_strength_MPa");
    const auto ratio = hole.number("shear_ratio");
    joint::TappedMaterial material;
    if (name) {
        const auto known = joint::tapped_material(*name);
        if (known)
            material = *known;
        else if (!(E && strength && ratio) &&
                 hole.all_valid({"E_GPa", "tensile_strength_MPa", "shear_ratio"}))
            reader.report(name.pointer, known.error().what,
                          known.error().expected.starts_with("did you mean")
                              ? known.error().expected
                              : known.error().expected +
                                    ", or another one with E_GPa, tensile_strength_MPa and shear_ratio");
        material.name = *name;
    }
    if (E) material.E = *E * 1e9;
    if (strength) material.R_m = *strength * 1e6;
    if (ratio) material.shear_ratio = *ratio;
    return material;
}

// Returns the enumerator that the member names; none if the member is missing. Reports a name that has no
// enumerator: the schema permits it, but no code implements it.
template <class Enum>
std::optional<Enum> read_name(const LayeredObject& layers, std::string_view key,
                              std::optional<Enum> (*named)(std::string_view)) {
    const Located<std::string> text = layers.text(key);
    if (!text) return std::nullopt;
    const std::optional<Enum> found = named(*text);
    if (!found)
        layers.reader().report(text.pointer, fmt::format("\"{}\" is not implemented", *text),
                               "another value of the schema");
    return found;
}

}  // namespace

void read_form(const LayeredObject& layers, joint::JointDesign& design) {
    using joint::JointForm;
    design.form = read_name(layers, "form", joint::joint_form_named).value_or(JointForm::through_bolt);
    design.head = read_name(layers, "head", joint::head_shape_named).value_or(joint::HeadShape::hexagon);
    const std::string turned =
        layers.text("turned").value_or(design.form == JointForm::tapped_hole ? "head" : "nut");
    design.turned = turned == "head" ? joint::TurnedPart::head : joint::TurnedPart::nut;
    const LayeredObject hole = layers.member_layers("tapped_hole");
    if (!hole.objects().empty()) design.hole.material = read_tapped_material(hole);
    design.hole.engagement = hole.number("engagement_mm").value_or(0.0) * mm;
    design.hole.depth = hole.number("depth_mm").value_or(0.0) * mm;
    design.thread_direction = read_name(layers, "thread_direction", joint::thread_direction_named)
                                  .value_or(joint::ThreadDirection::right);
    design.counter_hold =
        read_name(layers, "counter_hold", joint::counter_hold_named).value_or(joint::CounterHold::fixed);
    design.locking_insert = layers.boolean("locking_insert").value_or(false);
}

double usual_prevailing_torque(const joint::JointDesign& design) {
    const joint::LockingNut* const nut =
        design.locking_insert ? joint::locking_nut(design.thread.size.name) : nullptr;
    return nut ? 0.5 * nut->most_on : 0.0;
}

}  // namespace bolt::content
