#include "tools/author/preview/check_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/format/json_document.hpp"
#include "game/view/labels.hpp"

namespace bolt::author {

namespace {

using geometry::DrawnToolRoom;

constexpr float tool_opacity = 0.45F;
constexpr double whole_turn = to_radians(359.0);  // of free swing: the tool is drawn once
// Outer/inner radius of the small sectors of joints that are not selected; limited so that those of
// neighbours do not overlap.
constexpr double least_small_fan = 1.6, greatest_small_fan = 4.0;
constexpr glm::vec4 problem_plate{0.65F, 0.12F, 0.02F, 0.9F};
constexpr float mark_height_px = 26.0F;  // of a label above its joint

}  // namespace

const std::string& CheckOverlay::id_of(const DrawnToolRoom& room) const {
    return checked_->assembly.joints[room.joint].design.id;
}

void CheckOverlay::show(std::unique_ptr<CheckedAssembly> checked) {
    release();
    checked_ = std::move(checked);
    problems_ = checked_ ? problems_of(*checked_) : std::vector<Problem>();
    marked_.clear();
    obstructions_.clear();
}

// A part that this level of detail lacks is not marked.
void CheckOverlay::find_nodes(const view::LoadedModel& model) {
    marked_.clear();
    obstructions_.clear();
    for (const Problem& problem : problems_) {
        if (!problem.joint) continue;
        auto nodes = view::nodes_of(model.model, checked_->assembly.joints[*problem.joint].node);
        if (nodes) marked_.emplace(*problem.joint, std::move(*nodes));
    }
    const DrawnToolRoom* room = room_of(selected_);
    if (room == nullptr || room->obstruction == geometry::no_part) return;
    auto nodes = view::nodes_of(model.model, checked_->rooms->scene.parts[room->obstruction].name);
    if (nodes) obstructions_ = std::move(*nodes);
}

void CheckOverlay::release() {
    fans_.clear();
    small_fans_.clear();
    tools_.clear();
    labels_.clear();
    selected_.clear();
    all_ = false;
}

const DrawnToolRoom* CheckOverlay::room_of(const std::string& joint) const {
    if (!checked_ || !checked_->rooms) return nullptr;
    for (const DrawnToolRoom& room : checked_->rooms->failing)
        if (id_of(room) == joint) return &room;
    for (const DrawnToolRoom& room : checked_->rooms->joints)
        if (id_of(room) == joint) return &room;
    return nullptr;
}

std::string CheckOverlay::description_of(const std::string& joint) const {
    const DrawnToolRoom* room = room_of(joint);
    if (room == nullptr) return {};
    const content::Assembly& assembly = checked_->assembly;
    std::string text = describe_room(*room, blockers_of(*checked_->rooms, *room),
                                     room->tool == 0 ? std::string() : assembly.tools[room->tool].name);
    if (room->obstruction != geometry::no_part)
        text += fmt::format("; {} is in the way of the tool",
                            content::in_quotes(checked_->rooms->scene.parts[room->obstruction].name));
    const std::string entry = fmt::format("/joints/{}", assembly.joints[room->joint].index_in_file);
    for (const Error& note : checked_->findings.notes)
        if (note.pointer == entry) text += fmt::format("\nNote: {}", note.what);
    return text;
}

Status CheckOverlay::upload_selected(gpu::Device& device, const DrawnToolRoom& room) {
    if (!fans_.contains(room.joint)) {
        DrawnFan fan{make_swing_fan(room.swing, ring_of(*checked_->rooms, room)), {}};
        BOLT_TRY_ASSIGN(fan.gpu, render::upload_model(device, fan.model));
        fans_.emplace(room.joint, std::move(fan));
    }
    if (tools_.contains(room.tool)) return {};
    UploadedTool tool;
    BOLT_TRY_ASSIGN(tool.tool, load_drawn_tool(checked_->assembly.tools[room.tool].wrench));
    BOLT_TRY_ASSIGN(tool.gpu, render::upload_model(device, tool.tool.model));
    tools_.emplace(room.tool, std::move(tool));
    return {};
}

Status CheckOverlay::upload_small_fan(gpu::Device& device, const DrawnToolRoom& room) {
    if (small_fans_.contains(room.joint)) return {};
    double nearest = 1e9;
    const std::vector<content::AssemblyJoint>& joints = checked_->assembly.joints;
    for (std::size_t i = 0; i < joints.size(); ++i)
        if (i != room.joint)
            nearest = std::min(nearest, glm::distance(joints[i].design.seat, joints[room.joint].design.seat));
    FanRing ring = ring_of(*checked_->rooms, room);
    ring.outer = std::min(
        ring.outer, ring.inner * std::clamp(0.5 * nearest / ring.inner, least_small_fan, greatest_small_fan));
    DrawnFan fan{make_swing_fan(room.swing, ring), {}};
    BOLT_TRY_ASSIGN(fan.gpu, render::upload_model(device, fan.model));
    small_fans_.emplace(room.joint, std::move(fan));
    return {};
}

Status CheckOverlay::prepare(gpu::Device& device, const view::LoadedModel& model, const std::string& selected,
                             bool all) {
    selected_ = selected;
    all_ = all;
    find_nodes(model);
    const DrawnToolRoom* room = room_of(selected);
    if (room != nullptr && room->gripped) BOLT_TRY(upload_selected(device, *room));
    if (!all || !checked_ || !checked_->rooms) return {};
    for (const DrawnToolRoom& other : checked_->rooms->joints)
        if (other.gripped) BOLT_TRY(upload_small_fan(device, other));
    return {};
}

// Draws the tool as a ghost where its free swing begins and where it ends; in red if it fits at no angle or
// cannot be brought onto the joint.
void CheckOverlay::add_tool(render::Scene& scene, const DrawnToolRoom& room) const {
    const UploadedTool& tool = tools_.at(room.tool);
    const geometry::Arc* arc = room.swing.widest();
    std::vector<double> handles{room.handle};
    if (arc != nullptr && arc->width() < whole_turn) handles = {arc->from, arc->to};
    for (const double handle : handles) {
        const std::size_t first = scene.objects.size();
        render::add_model(scene, tool.tool.model, tool.gpu,
                          glm::mat4(tool_pose(room, handle) * tool.tool.from_model));
        for (std::size_t i = first; i < scene.objects.size(); ++i) {
            scene.objects[i].opacity = tool_opacity;
            if (arc == nullptr || room.obstruction != geometry::no_part)
                scene.objects[i].tint = glm::vec4(glm::vec3(problem_color), 0.8F);
        }
    }
}

// Outlines the joints with a problem and puts a label above each.
void CheckOverlay::mark_problems(render::Scene& scene) const {
    for (const auto& [joint, nodes] : marked_)
        for (render::Object& object : scene.objects)
            if (nodes.contains(object.node) && object.outline.w == 0.0F) object.outline = problem_color;
    for (render::Object& object : scene.objects)
        if (obstructions_.contains(object.node)) object.outline = problem_color;
    for (const auto& [joint, nodes] : marked_) {
        const content::AssemblyJoint& marked = checked_->assembly.joints[joint];
        render::Label label;
        label.text = fmt::format("{} {}", view::symbol_of(lesson::Verdict::high), marked.design.id);
        label.position = glm::vec3(marked.design.seat);
        label.offset_px = {0.0F, mark_height_px};
        label.plate = problem_plate;
        label.occluded_visibility = 1.0F;
        scene.labels.push_back(std::move(label));
    }
}

void CheckOverlay::add_to(render::Scene& scene, const render::Eye& eye, const glm::vec2& picture) {
    labels_.clear();
    if (!checked_) return;
    const std::size_t first_mark = scene.labels.size();
    mark_problems(scene);
    if (const DrawnToolRoom* room = room_of(selected_); room != nullptr && room->gripped) {
        const DrawnFan& fan = fans_.at(room->joint);
        add_fan(scene, fan.model, fan.gpu, *room);
        add_tool(scene, *room);
        add_room_labels(scene, *checked_->rooms, *room, blockers_of(*checked_->rooms, *room));
    }
    if (all_ && checked_->rooms)
        for (const DrawnToolRoom& room : checked_->rooms->joints)
            if (room.gripped && id_of(room) != selected_) {
                const DrawnFan& fan = small_fans_.at(room.joint);
                add_fan(scene, fan.model, fan.gpu, room);
            }
    if (scene.labels.empty()) return;
    if (!fonts_) {
        Result<text::Fonts> fonts = text::load_fonts();
        if (!fonts) return;  // the renderer reports the same error
        fonts_ = std::move(*fonts);
    }
    view::separate_labels(*fonts_, scene.labels, eye, picture);
    std::size_t i = first_mark;
    for (const auto& [joint, nodes] : marked_) {
        const view::LabelBox box = view::box_of(*fonts_, scene.labels[i++], eye, picture);
        if (box.visible) labels_.push_back({checked_->assembly.joints[joint].design.id, {box.low, box.high}});
    }
}

std::string CheckOverlay::joint_of_label(const glm::vec2& at) const {
    for (const LabelPlace& label : labels_)
        if (at.x >= label.box.low.x && at.x <= label.box.high.x && at.y >= label.box.low.y &&
            at.y <= label.box.high.y)
            return label.joint;
    return {};
}

}  // namespace bolt::author
