#include "tools/author/geometry/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "content/format/json_document.hpp"
#include "engine/assets/gltf.hpp"
#include "game/tool_models/tool_model.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/wrench_room.hpp"

namespace bolt::geometry {

namespace {

std::optional<FlattenedModel> read_scene(const std::string& path, std::string_view pointer,
                                         const Messages& messages) {
    if (path.empty()) return std::nullopt;
    const auto model = assets::read_gltf(path);
    if (!model) {
        messages.error(pointer, fmt::format("the file cannot be read: {}", model.error().message()), {});
        return std::nullopt;
    }
    check_file_size(path, pointer, messages);
    FlattenedModel scene = flatten(*model);
    if (scene.triangle_count() == 0) {
        messages.error(pointer, "the file has no triangles", "triangles in its default scene");
        return std::nullopt;
    }
    return scene;
}

// The wrench that the trainer generates for a tool without a model.
WrenchShape generated_wrench(const content::WrenchDesign& design, const std::string& pointer,
                             const Messages& messages) {
    content::WrenchDesign bare = design;
    bare.model.clear();
    auto wrench = wrench_from_model(flatten(tool_models::contact_model(tool_models::parameters_of(bare))),
                                    bare, ModelFrame::tool);
    if (!wrench) {
        messages.error(pointer, wrench.error().what, wrench.error().expected);
        return {};
    }
    if (design.model.empty())
        messages.note(pointer, fmt::format("no model is named, so the tool is generated: {}",
                                           tool_models::description(tool_models::parameters_of(bare))));
    return std::move(*wrench);
}

// Loads the author's wrench. Reports its errors and replaces it by a generated one. `pointer`: of the tool.
WrenchShape load_wrench(const content::WrenchDesign& design, const std::string& pointer,
                        const Messages& messages) {
    const std::string model = pointer + "/model";
    if (const auto scene = read_scene(design.model, model, messages)) {
        auto wrench = wrench_from_model(*scene, design);
        if (wrench) return std::move(*wrench);
        messages.error(model, wrench.error().what, wrench.error().expected);
    }
    return generated_wrench(design, pointer, messages);
}

// The default wrench first, then those of "more_tools".
std::vector<WrenchShape> load_wrenches(const content::Assembly& assembly, const Messages& messages) {
    std::vector<WrenchShape> wrenches;
    for (const content::Tool& tool : assembly.tools) {
        const bool is_default = wrenches.empty();
        const std::string at = is_default ? "/tool" : "/more_tools/" + content::pointer_token(tool.name);
        wrenches.push_back(load_wrench(tool.wrench, at, messages));
        if (!is_default) wrenches.back().name = "the tool " + content::in_quotes(tool.name);
    }
    return wrenches;
}

Bvh build_bvh(const FlattenedModel& scene) {
    std::vector<Triangle> triangles;
    triangles.reserve(scene.triangle_count());
    for (const ModelPart& part : scene.parts)
        triangles.insert(triangles.end(), part.triangles.begin(), part.triangles.end());
    return Bvh(std::move(triangles));
}

WrenchRoom describe_joint(std::size_t index, const JointParts& parts) {
    WrenchRoom room;
    room.joint = index;
    room.to_assembly = parts.to_assembly;
    room.turned = parts.turned.box;
    for (const Fastener* fastener : {&parts.bolt, &parts.washer_head, &parts.washer_nut, &parts.nut})
        room.parts.insert(fastener->parts.begin(), fastener->parts.end());
    return room;
}

WrenchRooms check_model(const content::Assembly& assembly, FlattenedModel&& scene, const Messages& messages) {
    check_triangles(scene, near_budget, "/model", messages);
    std::vector<WrenchShape> wrenches = load_wrenches(assembly, messages);
    const std::vector<int> nodes = check_nodes(assembly, scene, messages);
    WrenchRooms rooms;
    rooms.everything = build_bvh(scene);
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        if (nodes[i] < 0) continue;
        const content::AssemblyJoint& joint = assembly.joints[i];
        const JointParts parts = find_joint_parts(scene, nodes[i], joint.design);
        WrenchRoom room = describe_joint(i, parts);
        if (check_fasteners_and_members(joint, i, parts, scene, rooms.everything, assembly.tools, messages))
            for (const WrenchShape& wrench : wrenches)
                check_wrench(joint, i, parts, scene, wrench, messages,
                             &wrench == wrenches.data() ? &room : nullptr);
        rooms.joints.push_back(std::move(room));
    }
    rooms.wrench = std::move(wrenches.front());
    rooms.scene = std::move(scene);
    return rooms;
}

}  // namespace

Findings check_geometry(const content::Assembly& assembly, std::optional<WrenchRooms>* rooms) {
    Findings findings;
    const auto document = content::JsonDocument::parse(assembly.text, assembly.file, findings.errors);
    if (!document) return findings;
    const Messages messages{*document, findings};
    auto model = read_scene(assembly.models.model, "/model", messages);
    const auto far = read_scene(assembly.models.far_level, "/model_far", messages);
    const auto contact = read_scene(assembly.models.contact, "/contact_model", messages);
    if (far) check_triangles(*far, far_budget, "/model_far", messages);
    if (model && far) check_names(*model, *far, messages);
    if (model && contact) check_contact(*contact, *model, messages);
    if (model) {
        WrenchRooms found = check_model(assembly, std::move(*model), messages);
        if (rooms != nullptr) *rooms = std::move(found);
    }
    content::sort_by_position(findings.errors);
    content::sort_by_position(findings.notes);
    return findings;
}

}  // namespace bolt::geometry
