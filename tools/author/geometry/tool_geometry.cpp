#include "tools/author/geometry/tool_geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "game/tool_models/tool_model.hpp"

namespace bolt::geometry {

namespace {

constexpr double handle_from = 0.3;  // share of the reach beyond which a tool is all handle
constexpr double jaw_tolerance = 0.05 * mm;
constexpr double hole_play = 0.6 * mm;  // of a ring or a socket over its size
constexpr double key_play = 0.2 * mm;   // of a key under its size

Vec3 jaw_direction(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

// Measured with rays from the middle of the jaw: two across it that must hit, one out of the mouth that must
// not.
struct MeasuredJaw {
    double opening = 0.0, off_middle = 0.0;  // m
    bool found = false;
};

MeasuredJaw measure_jaw(const Bvh& bvh, double head_angle, double reach) {
    MeasuredJaw jaw;
    const Vec3 across = jaw_direction(head_angle + 0.5 * pi), mouth = -jaw_direction(head_angle);
    const auto left = first_hit(bvh, Vec3{0.0}, across, reach),
               right = first_hit(bvh, Vec3{0.0}, -across, reach);
    if (!left || !right || first_hit(bvh, Vec3{0.0}, mouth, reach)) return jaw;
    jaw.opening = left->distance + right->distance;
    jaw.off_middle = 0.5 * (left->distance - right->distance);
    jaw.found = true;
    return jaw;
}

tl::unexpected<Error> tool_error(std::string what, std::string expected) {
    return fail(ErrorCode::bad_content, std::move(what), std::move(expected));
}

// Measures the jaw of an open end, and sets what follows from it.
Status measure_open_end(ToolGeometry& tool, const content::WrenchDesign& design) {
    const Bvh bvh(tool.triangles);
    // The head may point to either side, because the wrench can be turned over.
    const MeasuredJaw left = measure_jaw(bvh, design.head_angle, tool.reach);
    const MeasuredJaw right = measure_jaw(bvh, -design.head_angle, tool.reach);
    if (!left.found && !right.found)
        return tool_error("the wrench has no jaw about its origin that opens at -X, turned by the head angle",
                          "the middle of the jaw at the origin, the handle along +X");
    const bool is_left = left.found && (!right.found || left.opening <= right.opening);
    const MeasuredJaw& jaw = is_left ? left : right;
    tool.head_angle = is_left ? design.head_angle : -design.head_angle;
    if (std::abs(jaw.opening - design.jaw) > jaw_tolerance)
        return tool_error(
            fmt::format("the jaw of the wrench measures {:.2f} mm in its model, and jaw_mm is {:g}",
                        jaw.opening / mm, design.jaw / mm),
            "both within 0.05 mm");
    if (std::abs(jaw.off_middle) > jaw_tolerance)
        return tool_error(
            fmt::format("the middle of the jaw is {:.2f} mm beside the origin of the wrench's model",
                        std::abs(jaw.off_middle) / mm),
            "the middle of the jaw at the origin");
    const double near_head = 1.3 * design.jaw;
    for (const Triangle& t : tool.triangles)
        for (const Vec3& p : {t.a, t.b, t.c})
            if (std::hypot(p.x, p.y) < near_head) {
                tool.half_thickness = std::max(tool.half_thickness, std::abs(p.z));
                tool.head_size = std::max(tool.head_size, std::hypot(p.x, p.y));
            }
    tool.top = tool.half_thickness;
    return {};
}

// Compares the hole of a ring or a socket, or the width of a key, with its size. Rays from the origin find
// the nearest point of its walls. The hole of a contact model may be round and reach to the corners.
Status check_grip(const ToolGeometry& tool, const content::WrenchDesign& design) {
    constexpr int rays = 72;
    const Bvh bvh(tool.triangles);
    const bool is_key = std::holds_alternative<collision::HexKey>(tool.head);
    const char* part = is_key ? "key" : "hole";
    double nearest = tool.reach;
    for (int i = 0; i < rays; ++i) {
        const auto hit = first_hit(bvh, Vec3{0.0}, jaw_direction(i * 2.0 * pi / rays), tool.reach);
        if (!hit)
            return tool_error(fmt::format("the tool has no {} about its origin along Z", part),
                              fmt::format("the middle of the {} at the origin, the handle along +X", part));
        nearest = std::min(nearest, hit->distance);
    }
    const double low = is_key ? design.size - key_play : design.size;
    const double high = is_key ? design.size : design.size / std::cos(pi / 6.0) + hole_play;
    if (2.0 * nearest > low - jaw_tolerance && 2.0 * nearest < high + jaw_tolerance) return {};
    return tool_error(fmt::format("the {} of the tool measures {:.2f} mm in its model, and size_mm is {:g}",
                                  part, 2.0 * nearest / mm, design.size / mm),
                      "a model of this size");
}

// Sets the height of the handle, and of the upper side of a tool that is no open end.
void measure_handle(ToolGeometry& tool) {
    double low = std::numeric_limits<double>::infinity(), high = -low, top = -low;
    for (const Triangle& t : tool.triangles)
        for (const Vec3& p : {t.a, t.b, t.c}) {
            top = std::max(top, p.z);
            if (p.x < handle_from * tool.reach) continue;
            low = std::min(low, p.z);
            high = std::max(high, p.z);
        }
    tool.top = top;
    if (low <= high && !tool.is_open_end()) tool.handle_height = 0.5 * (low + high);
}

}  // namespace

Result<ToolGeometry> tool_from_model(const FlattenedModel& scene, const content::WrenchDesign& design,
                                     ModelFrame frame) {
    ToolGeometry tool;
    Aabb box;
    for (const ModelPart& part : scene.parts) {
        tool.triangles.insert(tool.triangles.end(), part.triangles.begin(), part.triangles.end());
        for (const Vec3& p : {part.box.low, part.box.high})
            if (!part.box.empty()) box.add(p);
    }
    if (tool.triangles.empty()) return tool_error("the wrench has no triangles", "a mesh");
    const bool lies = frame == ModelFrame::found && box.half().y < box.half().z;
    for (Triangle& t : tool.triangles) {
        for (Vec3* p : {&t.a, &t.b, &t.c}) {
            if (lies) *p = {p->x, -p->z, p->y};
            tool.reach = std::max(tool.reach, std::hypot(p->x, p->y));
        }
        t.part = 0;
    }
    if (tool.reach > 5.0 || tool.reach < 0.02)
        return tool_error(fmt::format("the wrench is {:.4g} mm long", tool.reach / mm),
                          tool.reach > 5.0 ? "metres: it looks like millimetres" : "metres, as in glTF");
    const tool_models::GrippingHead gripping = tool_models::gripping_head(design);
    tool.head = gripping.head;
    tool.head_angle = gripping.head_angle;
    measure_handle(tool);
    if (tool.is_open_end()) {
        BOLT_TRY(measure_open_end(tool, design));
    } else if (frame == ModelFrame::found) {
        BOLT_TRY(check_grip(tool, design));
    }
    return tool;
}

Result<ToolGeometry> generated_tool(const content::WrenchDesign& design) {
    content::WrenchDesign bare = design;
    bare.model.clear();
    return tool_from_model(flatten(tool_models::contact_model(tool_models::parameters_of(bare))), bare,
                           ModelFrame::tool);
}

Bvh place_on_joint(const ToolGeometry& tool, bool turned_over) {
    std::vector<Triangle> triangles = tool.triangles;
    const double side = turned_over ? -1.0 : 1.0;
    for (Triangle& t : triangles)
        for (Vec3* p : {&t.a, &t.b, &t.c}) *p = {p->x, side * p->z, -side * p->y};
    return Bvh(std::move(triangles));
}

}  // namespace bolt::geometry
