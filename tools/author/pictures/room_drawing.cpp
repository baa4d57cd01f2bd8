#include "tools/author/pictures/room_drawing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "content/format/json_document.hpp"
#include "engine/assets/gltf.hpp"
#include "game/session/contact_models.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::author {

using geometry::DrawnToolRoom;
using geometry::DrawnToolRooms;

namespace {

// Points that a picture should show, m, in the assembly's frame.
struct PictureContents {
    std::vector<Vec3> visible;  // parts in front of these make a view worse
    std::vector<Vec3> framed;   // all are in the picture
};

constexpr double tilts[] = {to_radians(40.0), to_radians(25.0), to_radians(58.0)};  // from the joint's axis
constexpr int sides = 24;
constexpr double filled = 0.94;  // of the picture
// Bonuses of a view, as visible fractions: for the preferred tilt, from above, and across the handle.
constexpr double tilt_weight = 0.05, above_weight = 0.06, across_weight = 0.06;

constexpr double fan_reach = 0.62;  // outer radius of the fan, as a fraction of the wrench's reach
constexpr float fan_opacity = 0.35F;
constexpr double least_named = to_radians(8.0);      // narrower blocked directions get no label
constexpr double least_described = to_radians(1.5);  // narrower ones are not printed
constexpr std::size_t most_names = 4;                // labels in a picture

// The part to name for a blocked direction: the one that collides, or one in front of it, such as the casing
// that hides a wheel.
std::uint32_t foremost_part(const DrawnToolRooms& rooms, const DrawnToolRoom& room,
                            const geometry::BlockedArc& arc) {
    const double angle = 0.5 * (arc.from + arc.to);
    const geometry::ToolGeometry& tool = rooms.tools[room.tool];
    const Vec3 from(room.to_assembly * glm::dvec4(0.0, room.height + tool.handle_height, 0.0, 1.0));
    const Vec3 out = glm::normalize(Vec3(room.to_assembly * glm::dvec4(fan_point(angle, 1.0, 0.0), 0.0)));
    const auto hit_of = [&](const geometry::SkipPart& skip) {
        return geometry::first_hit(rooms.everything, from, out, tool.reach, skip);
    };
    const auto foremost = hit_of([&](std::uint32_t part) { return room.parts.contains(part); });
    const auto blocking = hit_of([&](std::uint32_t part) { return part != arc.part; });
    if (!foremost || !blocking || foremost->distance >= blocking->distance) return arc.part;
    return rooms.everything.triangles()[foremost->triangle].part;
}

double visible_share(const geometry::DrawnToolRooms& rooms, const geometry::DrawnToolRoom& room,
                     const std::vector<Vec3>& points, const Vec3& back) {
    constexpr double reach = 10.0;  // m
    const auto seen = std::count_if(points.begin(), points.end(), [&](const Vec3& point) {
        return !geometry::first_hit(rooms.everything, point, back, reach,
                                    [&](std::uint32_t part) { return room.parts.contains(part); });
    });
    return points.empty() ? 1.0 : static_cast<double>(seen) / static_cast<double>(points.size());
}

PictureContents contents_of(const DrawnToolRooms& rooms, const DrawnToolRoom& room) {
    const FanRing ring = ring_of(rooms, room);
    PictureContents contents;
    const auto in_assembly = [&](const Vec3& p) { return Vec3(room.to_assembly * glm::dvec4(p, 1.0)); };
    const Vec3 low = room.turned.empty() ? Vec3(-0.02) : room.turned.low;
    const Vec3 high = room.turned.empty() ? Vec3(0.02) : room.turned.high;
    const double radius = std::max(high.x, high.z);
    for (int i = 0; i < 12; ++i) {
        const double angle = i * pi / 6.0;
        contents.visible.push_back(in_assembly(fan_point(angle, 0.9 * radius, high.y + 0.1 * mm)));
        for (const double height : {low.y, high.y})
            contents.framed.push_back(
                in_assembly(fan_point(angle, (room.gripped ? 1.5 : 6.0) * radius, height)));
    }
    if (!room.gripped) return contents;
    const geometry::ToolGeometry& tool = rooms.tools[room.tool];
    const double top = room.height + tool.top + 0.1 * mm;
    for (int i = 1; i <= 8; ++i)
        contents.visible.push_back(in_assembly(fan_point(room.handle, i / 8.0 * tool.reach, top)));
    const auto add_arc = [&](double from, double to, bool is_free) {
        for (int i = 0; i <= 24; ++i) {
            const double angle = from + (to - from) * i / 24.0;
            contents.framed.push_back(in_assembly(fan_point(angle, ring.outer, ring.height)));
            if (!is_free || i % 4 != 2) continue;
            for (const double share : {0.4, 0.8})
                contents.visible.push_back(in_assembly(fan_point(angle, share * ring.outer, ring.height)));
        }
    };
    for (const geometry::Arc& arc : room.swing.arcs) add_arc(arc.from, arc.to, true);
    for (const geometry::BlockedArc& arc : room.swing.blocked) add_arc(arc.from, arc.to, false);
    const glm::dmat4 pose = tool_pose(room, room.handle);
    for (const geometry::Triangle& t : tool.triangles)
        contents.framed.emplace_back(pose * glm::dvec4(t.a, 1.0));
    return contents;
}

}  // namespace

FanRing ring_of(const DrawnToolRooms& rooms, const DrawnToolRoom& room) {
    const geometry::ToolGeometry& tool = rooms.tools[room.tool];
    return {1.1 * std::hypot(room.turned.half().x, room.turned.half().z), fan_reach * tool.reach,
            room.height + tool.handle_height};
}

glm::dmat4 tool_pose(const DrawnToolRoom& room, double handle) {
    const double side = room.turned_over ? -1.0 : 1.0;
    // The same axes as geometry::place_on_joint().
    const glm::dmat4 on_joint(glm::dvec4(1.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 0.0, -side, 0.0),
                              glm::dvec4(0.0, side, 0.0, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    return glm::rotate(glm::translate(room.to_assembly, Vec3(0.0, room.height, 0.0)), handle,
                       Vec3(0.0, 1.0, 0.0)) *
           on_joint;
}

Result<DrawnTool> load_drawn_tool(const content::WrenchDesign& design) {
    if (design.model.empty())
        return DrawnTool{tool_models::drawn_model(tool_models::parameters_of(design)), glm::dmat4(1.0)};
    BOLT_TRY_ASSIGN(auto model, assets::read_gltf(design.model));
    BOLT_TRY_ASSIGN(const auto turn, session::wrench_rotation(design));
    return DrawnTool{std::move(model), glm::mat4_cast(turn)};
}

std::vector<Blocker> blockers_of(const DrawnToolRooms& rooms, const DrawnToolRoom& room) {
    std::vector<Blocker> blockers;
    for (const geometry::BlockedArc& arc : room.swing.blocked) {
        const std::string& name = rooms.scene.parts[foremost_part(rooms, room, arc)].name;
        auto found = std::find_if(blockers.begin(), blockers.end(),
                                  [&](const Blocker& blocker) { return blocker.name == name; });
        if (found == blockers.end()) found = blockers.insert(blockers.end(), {name});
        const double width = arc.to - arc.from;
        found->total += width;
        if (width <= found->widest) continue;
        found->widest = width;
        found->middle = 0.5 * (arc.from + arc.to);
    }
    std::stable_sort(blockers.begin(), blockers.end(),
                     [](const Blocker& a, const Blocker& b) { return a.total > b.total; });
    return blockers;
}

std::string describe_room(const DrawnToolRoom& room, const std::vector<Blocker>& blockers,
                          const std::string& tool) {
    if (room.turned.empty()) return "the model has no part that is turned";
    if (!room.gripped) return "the tool cannot grip the part that is turned";
    const geometry::Arc* arc = room.swing.widest();
    std::string text =
        fmt::format("{:.1f} degrees of free swing", arc == nullptr ? 0.0 : to_degrees(arc->width()));
    if (!tool.empty()) text += fmt::format(" with the tool {}", content::in_quotes(tool));
    if (room.turned_over) text += ", the wrench turned over";
    const char* separator = "; blocked by ";
    for (const Blocker& blocker : blockers) {
        if (blocker.total < least_described) continue;
        text += fmt::format("{}{} ({:.0f} degrees)", separator, content::in_quotes(blocker.name),
                            to_degrees(blocker.total));
        separator = ", ";
    }
    return text;
}

void add_fan(render::Scene& scene, const assets::Model& fan, const render::GpuModel& gpu_fan,
             const DrawnToolRoom& room) {
    const std::size_t first = scene.objects.size();
    render::add_model(scene, fan, gpu_fan, glm::mat4(room.to_assembly));
    for (std::size_t i = first; i < scene.objects.size(); ++i) {
        render::Object& sector = scene.objects[i];
        const auto mesh = static_cast<FanMesh>(sector.mesh);
        const bool is_free = mesh == FanMesh::free || mesh == FanMesh::free_rim;
        sector.tint = is_free ? free_color : blocked_color;
        sector.flat = true;
        if (mesh == FanMesh::free || mesh == FanMesh::blocked) sector.opacity = fan_opacity;
    }
}

void add_room_labels(render::Scene& scene, const DrawnToolRooms& rooms, const DrawnToolRoom& room,
                     const std::vector<Blocker>& blockers) {
    const FanRing ring = ring_of(rooms, room);
    const std::size_t first = scene.labels.size();
    const auto add = [&](const std::string& text, double angle, const glm::vec4& color) {
        render::Label label;
        label.text = text;
        label.position =
            glm::vec3(room.to_assembly * glm::dvec4(fan_point(angle, 0.8 * ring.outer, ring.height), 1.0));
        label.plate = color;
        label.occluded_visibility = 1.0F;
        scene.labels.push_back(std::move(label));
    };
    for (const Blocker& blocker : blockers)
        if (blocker.total >= least_named && scene.labels.size() < first + most_names)
            add(blocker.name, blocker.middle, {0.6F, 0.05F, 0.05F, 0.85F});
    if (const geometry::Arc* arc = room.swing.widest())
        add(fmt::format("{:.0f}°", to_degrees(arc->width())), arc->from + 0.25 * arc->width(),
            {0.05F, 0.4F, 0.12F, 0.85F});
}

view::Orbit joint_view(const geometry::DrawnToolRooms& rooms, const geometry::DrawnToolRoom& room,
                       double aspect) {
    const PictureContents contents = contents_of(rooms, room);
    const glm::dmat3 turn(room.to_assembly);
    const Vec3 handle = turn * Vec3(std::cos(room.handle), 0.0, -std::sin(room.handle));
    Vec3 best(0.0);
    double most = -1.0;
    for (const double tilt : tilts)
        for (int i = 0; i < sides; ++i) {
            const double side = 2.0 * pi * i / sides;
            const Vec3 back = glm::normalize(turn * Vec3(std::sin(tilt) * std::cos(side), std::cos(tilt),
                                                         std::sin(tilt) * std::sin(side)));
            const double worth = visible_share(rooms, room, contents.visible, back) -
                                 tilt_weight * std::abs(tilt - tilts[0]) / tilts[0] + above_weight * back.y -
                                 across_weight * std::abs(glm::dot(back, handle));
            if (worth <= most + 1e-9) continue;
            most = worth;
            best = back;
        }
    view::Viewpoint viewpoint;
    Vec3 low(1e9), high(-1e9);
    for (const Vec3& p : contents.framed) low = glm::min(low, p), high = glm::max(high, p);
    viewpoint.target = glm::vec3(0.5 * (low + high));
    viewpoint.eye = viewpoint.target + glm::vec3(best);
    viewpoint.fov = view::default_fov;
    view::Orbit orbit = view::orbit_of(viewpoint);
    const auto [right, up, back] = view::axes_of(orbit);
    const auto span_of = [&](const Vec3& axis) {
        double least = 1e9, greatest = -1e9;
        for (const Vec3& p : contents.framed) {
            const double at = glm::dot(p - orbit.target, axis);
            least = std::min(least, at);
            greatest = std::max(greatest, at);
        }
        return 0.5 * (least + greatest);
    };
    const Vec3 shift = span_of(right) * right + span_of(up) * up;
    orbit.target += shift;
    const double half = filled * std::tan(0.5 * orbit.fov);
    orbit.distance = 1e-3;
    for (const Vec3& p : contents.framed) {
        const Vec3 d = p - orbit.target;
        const double needed =
            std::max(std::abs(glm::dot(d, up)) / half, std::abs(glm::dot(d, right)) / (half * aspect));
        orbit.distance = std::max(orbit.distance, needed + glm::dot(d, best));
    }
    return orbit;
}

}  // namespace bolt::author
