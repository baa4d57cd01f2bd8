#include "tools/author/preview/joint_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "content/format/assembly.hpp"
#include "content/format/json_document.hpp"
#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::author {

namespace {

std::string tool_name(const content::Assembly& assembly, const content::AssemblyJoint& joint) {
    const content::WrenchDesign* design = &content::tool_of(assembly, joint);
    for (const content::Tool& tool : assembly.tools)
        if (&tool.wrench == design) return tool.name;
    return assembly.tool;
}

SelectableJoint describe_joint(const content::Assembly& assembly, const content::AssemblyJoint& joint,
                               const content::JsonDocument& document) {
    const Error entry =
        document.error(geometry::joint_pointer(joint.index_in_file), content::JsonPart::value, {}, {});
    return {joint.design.id, joint.node, fmt::format("{}:{}:{}", entry.file, entry.line, entry.column),
            fmt::format("type {}, tool {}", joint.type, tool_name(assembly, joint))};
}

}  // namespace

Result<SelectableJoints> find_joints(const std::string& source, const std::string& variant,
                                     const view::LoadedModel& model) {
    SelectableJoints found;
    if (model.without_assembly) return found;
    content::LoadedAssembly loaded = content::load_assembly(source, variant);
    if (!loaded.ok()) return fail(std::move(loaded.errors.front()));
    const content::Assembly& assembly = loaded.assembly;
    found.variant = assembly.variant;
    const bool has_default =
        assembly.variants.empty() || !content::load_assembly(source).assembly.variant.empty();
    if (!has_default) found.variants.emplace_back();
    for (const content::AssemblyVariant& known : assembly.variants) found.variants.push_back(known.name);
    std::vector<Error> errors;
    const auto document = content::JsonDocument::parse(assembly.text, assembly.file, errors);
    if (!document) return fail(std::move(errors.front()));
    const geometry::FlattenedModel scene = geometry::flatten(model.model);
    std::vector<geometry::Triangle> triangles;
    for (const geometry::ModelPart& part : scene.parts)
        triangles.insert(triangles.end(), part.triangles.begin(), part.triangles.end());
    found.triangles = geometry::Bvh(std::move(triangles));
    found.joint_of_part.assign(scene.parts.size(), -1);
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const auto nodes = scene.by_name.find(joint.node);
        if (nodes == scene.by_name.end()) continue;
        const int index = static_cast<int>(found.joints.size());
        found.joints.push_back(describe_joint(assembly, joint, *document));
        for (std::size_t part = 0; part < scene.parts.size(); ++part)
            if (scene.is_under(scene.parts[part].node, nodes->second.front()))
                found.joint_of_part[part] = index;
    }
    return found;
}

const SelectableJoint* joint_named(const SelectableJoints& joints, std::string_view id) {
    const auto found = std::find_if(joints.joints.begin(), joints.joints.end(),
                                    [&](const SelectableJoint& joint) { return joint.id == id; });
    return found == joints.joints.end() ? nullptr : &*found;
}

const SelectableJoint* joint_at(const SelectableJoints& joints, const view::Orbit& camera, glm::dvec2 at) {
    constexpr double reach = 1e3;  // m
    const auto [right, up, back] = view::axes_of(camera);
    const Vec3 eye = camera.target + camera.distance * back;
    const double span = 2.0 * std::tan(0.5 * camera.fov);  // height of the picture at a distance of 1
    const Vec3 direction = glm::normalize(span * (at.x * right + at.y * up) - back);
    const auto hit = geometry::first_hit(joints.triangles, eye, direction, reach);
    if (!hit) return nullptr;
    const int joint = joints.joint_of_part[joints.triangles.triangles()[hit->triangle].part];
    return joint < 0 ? nullptr : &joints.joints[static_cast<std::size_t>(joint)];
}

std::string selection_line(const SelectableJoint& joint) {
    return fmt::format("{}: joint {}: {}\n", joint.location, joint.id, joint.description);
}

}  // namespace bolt::author
