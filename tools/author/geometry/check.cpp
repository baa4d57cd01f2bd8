#include "tools/author/geometry/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "content/format/json_document.hpp"
#include "engine/assets/gltf.hpp"
#include "game/tool_models/tool_model.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"
#include "tools/author/geometry/joint_tools.hpp"

namespace bolt::geometry {

namespace {

// Reads a model that consists of these files.
std::optional<FlattenedModel> read_scene(const std::vector<std::string>& parts, std::string_view pointer,
                                         const Messages& messages) {
    if (parts.empty()) return std::nullopt;
    assets::Model whole;
    for (const std::string& path : parts) {
        auto model = assets::read_gltf(path);
        if (!model) {
            messages.error(pointer, fmt::format("the file cannot be read: {}", model.error().message()), {});
            return std::nullopt;
        }
        check_file_size(path, pointer, messages);
        assets::append(whole, std::move(*model));
    }
    FlattenedModel scene = flatten(whole);
    if (scene.triangle_count() == 0) {
        messages.error(pointer, "the file has no triangles", "triangles in its default scene");
        return std::nullopt;
    }
    return scene;
}

// Loads the author's tool, or generates one. Reports the errors of a model and replaces it by a generated
// tool. `pointer`: of the tool.
ToolGeometry load_tool(const content::WrenchDesign& design, const std::string& pointer,
                       const Messages& messages) {
    const std::string model = pointer + "/model";
    std::vector<std::string> files;
    if (!design.model.empty()) files.push_back(design.model);
    if (const auto scene = read_scene(files, model, messages)) {
        auto tool = tool_from_model(*scene, design);
        if (tool) return std::move(*tool);
        messages.error(model, tool.error().what, tool.error().expected);
    }
    auto tool = generated_tool(design);
    if (!tool) {
        messages.error(pointer, tool.error().what, tool.error().expected);
        return {};
    }
    if (design.model.empty())
        messages.note(pointer, fmt::format("no model is named, so the tool is generated: {}",
                                           tool_models::description(tool_models::parameters_of(design))));
    return std::move(*tool);
}

// In the order of the assembly: the default tool, then those of "more_tools".
std::vector<ToolGeometry> load_tools(const content::Assembly& assembly, const Messages& messages) {
    std::vector<ToolGeometry> shapes;
    for (std::size_t i = 0; i < assembly.tools.size(); ++i) {
        const content::Tool& tool = assembly.tools[i];
        const bool is_first = tool.name == content::default_tool_name;
        const std::string at = is_first ? "/tool" : "/more_tools/" + content::pointer_token(tool.name);
        shapes.push_back(load_tool(tool.wrench, at, messages));
        shapes.back().name = name_of_tool(assembly, i);
    }
    return shapes;
}

Bvh build_bvh(const FlattenedModel& scene) {
    std::vector<Triangle> triangles;
    triangles.reserve(scene.triangle_count());
    for (const ModelPart& part : scene.parts)
        triangles.insert(triangles.end(), part.triangles.begin(), part.triangles.end());
    return Bvh(std::move(triangles));
}

DrawnToolRoom describe_joint(std::size_t index, const JointParts& parts) {
    DrawnToolRoom room;
    room.joint = index;
    room.to_assembly = parts.to_assembly;
    room.turned = parts.turned.box;
    for (const Fastener* fastener : {&parts.bolt, &parts.washer_head, &parts.washer_nut, &parts.nut})
        room.parts.insert(fastener->parts.begin(), fastener->parts.end());
    return room;
}

// The open ends among the tools of a joint.
std::vector<JawOpening> jaws_of(const content::Assembly& assembly, const std::vector<std::size_t>& tools) {
    std::vector<JawOpening> jaws;
    for (const std::size_t i : tools) {
        const content::Tool& tool = assembly.tools[i];
        if (tool.wrench.head != content::ToolHeadKind::open_end) continue;
        jaws.push_back({tool.name == content::default_tool_name
                            ? ""
                            : fmt::format(" (the tool {})", content::in_quotes(tool.name)),
                        tool.wrench.jaw});
    }
    return jaws;
}

DrawnToolRooms check_model(const content::Assembly& assembly, FlattenedModel&& scene,
                           const Messages& messages, CheckProgress& progress) {
    check_triangles(scene, near_budget, "/model", messages);
    ToolSet set(assembly, load_tools(assembly, messages));
    const std::vector<int> nodes = check_nodes(assembly, scene, messages);
    DrawnToolRooms rooms;
    rooms.everything = build_bvh(scene);
    const std::vector<Bvh> trees = build_part_trees(scene);
    progress.joints = assembly.joints.size();
    for (std::size_t i = 0; i < assembly.joints.size() && !progress.stop; progress.checked = ++i) {
        if (nodes[i] < 0) continue;
        const content::AssemblyJoint& joint = assembly.joints[i];
        const std::vector<std::size_t> tools = tools_of_joint(assembly, i);
        const JointParts parts = find_joint_parts(scene, nodes[i], joint.design);
        DrawnToolRoom room = describe_joint(i, parts);
        room.tool = tools.front();
        if (check_fasteners_and_members(joint, joint.index_in_file, parts, scene, rooms.everything,
                                        jaws_of(assembly, tools), messages)) {
            const JointSurroundings surroundings(joint, parts, scene, trees);
            check_tool_room(surroundings, joint.index_in_file, tools, set, messages, room, rooms.failing);
        }
        rooms.joints.push_back(std::move(room));
    }
    rooms.tools = std::move(set.shapes());
    rooms.scene = std::move(scene);
    return rooms;
}

}  // namespace

Findings check_tool_choice(const content::Assembly& assembly) {
    Findings findings;
    const auto document = content::JsonDocument::parse(assembly.text, assembly.file, findings.errors);
    if (!document) return findings;
    check_tools(assembly, {*document, findings});
    content::sort_by_position(findings.errors);
    content::sort_by_position(findings.notes);
    return findings;
}

Findings check_geometry(const content::Assembly& assembly, std::optional<DrawnToolRooms>* rooms,
                        CheckProgress* progress) {
    CheckProgress unwatched;
    Findings findings;
    const auto document = content::JsonDocument::parse(assembly.text, assembly.file, findings.errors);
    if (!document) return findings;
    const Messages messages{*document, findings};
    check_tools(assembly, messages);
    using content::ModelFiles;
    const auto read = [&](content::ModelFile file, std::string_view pointer) {
        return read_scene(content::model_paths(assembly, file), pointer, messages);
    };
    auto model = read(&ModelFiles::model, "/model");
    const auto far = read(&ModelFiles::far_level, "/model_far");
    const auto contact = read(&ModelFiles::contact, "/contact_model");
    if (far) check_triangles(*far, far_budget, "/model_far", messages);
    if (model && far) check_names(*model, *far, messages);
    if (model && contact) check_contact(*contact, *model, messages);
    if (model) {
        DrawnToolRooms found =
            check_model(assembly, std::move(*model), messages, progress != nullptr ? *progress : unwatched);
        if (rooms != nullptr) *rooms = std::move(found);
    }
    content::sort_by_position(findings.errors);
    content::sort_by_position(findings.notes);
    return findings;
}

}  // namespace bolt::geometry
