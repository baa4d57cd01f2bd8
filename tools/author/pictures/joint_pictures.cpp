#include "tools/author/pictures/joint_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "content/format/json_document.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/render/renderer.hpp"
#include "engine/text/fonts.hpp"
#include "game/session/contact_models.hpp"
#include "game/tool_models/tool_model.hpp"
#include "game/view/camera.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/labels.hpp"
#include "game/view/shown_model.hpp"
#include "tools/author/geometry/wrench_room.hpp"
#include "tools/author/pictures/swing_fan.hpp"

namespace bolt::author {

namespace {

namespace fs = std::filesystem;
using geometry::WrenchRoom;
using geometry::WrenchRooms;

// Points that a picture should show, m, in the assembly's frame.
struct PictureContents {
    std::vector<Vec3> visible;  // parts in front of these make a view worse
    std::vector<Vec3> framed;   // all are in the picture
};

constexpr double tilts[] = {to_radians(40.0), to_radians(25.0), to_radians(58.0)};  // from the joint's axis
constexpr int sides = 24;
constexpr double filled = 0.94;  // of the picture
// Visible fractions that the preferred tilt, a view from above and one across the handle are worth.
constexpr double tilt_weight = 0.05, above_weight = 0.06, across_weight = 0.06;

double visible_share(const geometry::WrenchRooms& rooms, const geometry::WrenchRoom& room,
                     const std::vector<Vec3>& points, const Vec3& back) {
    constexpr double reach = 10.0;  // m
    const auto seen = std::count_if(points.begin(), points.end(), [&](const Vec3& point) {
        return !geometry::first_hit(rooms.everything, point, back, reach,
                                    [&](std::uint32_t part) { return room.parts.contains(part); });
    });
    return points.empty() ? 1.0 : static_cast<double>(seen) / static_cast<double>(points.size());
}

// The nearest view from which all of `framed` is in the picture, from the side of the turned part from which
// the most of `visible` can be seen.
view::Orbit joint_view(const geometry::WrenchRooms& rooms, const geometry::WrenchRoom& room,
                       const PictureContents& contents, double aspect) {
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

constexpr double fan_reach = 0.62;  // outer radius of the fan, as a fraction of the wrench's reach
constexpr glm::vec4 free_color{0.1F, 0.8F, 0.25F, 1.0F}, blocked_color{0.95F, 0.1F, 0.1F, 1.0F};
constexpr glm::vec4 turned_color{1.0F, 0.78F, 0.1F, 1.0F};
constexpr float fan_opacity = 0.35F;
constexpr double least_named = to_radians(8.0);      // narrower blocked directions get no label
constexpr double least_described = to_radians(1.5);  // narrower ones are not printed
constexpr std::size_t most_names = 4;                // labels in a picture

// A part that blocks the wrench: how much of the revolution, and where its widest range is.
struct Blocker {
    std::string name;
    double total = 0.0, widest = 0.0, middle = 0.0;  // rad
};

// The part to name for a blocked direction: the one that collides, or one in front of it, such as the casing
// that hides a wheel.
std::uint32_t foremost_part(const WrenchRooms& rooms, const WrenchRoom& room,
                            const geometry::BlockedArc& arc) {
    const double angle = 0.5 * (arc.from + arc.to);
    const geometry::ToolShape& tool = rooms.tools[room.tool];
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

// The widest first.
std::vector<Blocker> blockers_of(const WrenchRooms& rooms, const WrenchRoom& room) {
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

// `tool`: name of the tool, if the joint has another one than the default.
std::string description(const WrenchRoom& room, const std::vector<Blocker>& blockers,
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

// A file name for any id.
std::string file_name(std::string id) {
    for (char& c : id)
        if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '_';
    if (id.starts_with('.')) id.front() = '_';
    return id + ".png";
}

// The pose of the tool's frame in the assembly's frame: on the turned part, at the handle's angle.
glm::dmat4 tool_pose(const WrenchRoom& room) {
    const double side = room.turned_over ? -1.0 : 1.0;
    // The same axes as geometry::place_on_joint().
    const glm::dmat4 on_joint(glm::dvec4(1.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 0.0, -side, 0.0),
                              glm::dvec4(0.0, side, 0.0, 0.0), glm::dvec4(0.0, 0.0, 0.0, 1.0));
    return glm::rotate(glm::translate(room.to_assembly, Vec3(0.0, room.height, 0.0)), room.handle,
                       Vec3(0.0, 1.0, 0.0)) *
           on_joint;
}

struct DrawnTool {
    assets::Model model;
    glm::dmat4 from_model{1.0};  // to the tool's frame
};

Result<DrawnTool> load_drawn_tool(const content::WrenchDesign& design) {
    if (design.model.empty())
        return DrawnTool{tool_models::drawn_model(tool_models::parameters_of(design)), glm::dmat4(1.0)};
    BOLT_TRY_ASSIGN(auto model, assets::read_gltf(design.model));
    BOLT_TRY_ASSIGN(const auto turn, session::wrench_rotation(design));
    return DrawnTool{std::move(model), glm::mat4_cast(turn)};
}

// Draws one picture after the other.
class JointPainter {
  public:
    static Result<std::unique_ptr<JointPainter>> create(const content::Assembly& assembly,
                                                        const WrenchRooms& rooms);

    // Returns the bytes of a PNG file.
    Result<std::string> draw(const WrenchRoom& room, const std::vector<Blocker>& blockers);

    ~JointPainter() {
        if (gpu_context_.device) (void)gpu_context_.device->idle();
    }
    JointPainter(const JointPainter&) = delete;
    JointPainter& operator=(const JointPainter&) = delete;

  private:
    JointPainter(const content::Assembly& assembly, const WrenchRooms& rooms)
        : assembly_(assembly), rooms_(rooms) {}

    Status show_turned_part(const WrenchRoom& room, render::Scene& scene) const;
    [[nodiscard]] FanRing ring_of(const WrenchRoom& room) const;
    [[nodiscard]] PictureContents contents_of(const WrenchRoom& room, const FanRing& ring) const;
    void add_labels(const WrenchRoom& room, const FanRing& ring, const std::vector<Blocker>& blockers,
                    render::Scene& scene) const;

    const content::Assembly& assembly_;
    const WrenchRooms& rooms_;
    text::Fonts fonts_;
    view::LoadedModel model_;
    std::map<std::size_t, DrawnTool> tools_;  // by index in Assembly::tools, those that a joint needs
    // Each of these depends on those above it.
    std::optional<gpu::Instance> instance_;
    view::GpuContext gpu_context_;
    render::EnvironmentLight light_;
    std::unique_ptr<view::ShownModel> shown_;
    std::map<std::size_t, render::GpuModel> gpu_tools_;
};

Result<std::unique_ptr<JointPainter>> JointPainter::create(const content::Assembly& assembly,
                                                           const WrenchRooms& rooms) {
    std::unique_ptr<JointPainter> painter(new JointPainter(assembly, rooms));
    view::ModelLoadResult loaded = view::load_model(assembly.file, view::DetailLevel::near, assembly.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    painter->model_ = std::move(loaded.model);
    for (const WrenchRoom& room : rooms.joints) {
        if (painter->tools_.contains(room.tool)) continue;
        BOLT_TRY_ASSIGN(painter->tools_[room.tool], load_drawn_tool(assembly.tools[room.tool].wrench));
    }
    BOLT_TRY_ASSIGN(painter->fonts_, text::load_fonts());
    BOLT_TRY_ASSIGN(const auto radiance, view::load_light("studio"));
    BOLT_TRY_ASSIGN(auto instance, gpu::Instance::create({}));
    painter->instance_.emplace(std::move(instance));
    render::RendererOptions renderer;
    renderer.level_error_px = 0.5F;
    BOLT_TRY_ASSIGN(painter->gpu_context_, view::make_gpu_context(*painter->instance_, {}, renderer));
    gpu::Device& device = *painter->gpu_context_.device;
    BOLT_TRY_ASSIGN(painter->light_, render::upload_environment(device, radiance));
    BOLT_TRY_ASSIGN(painter->shown_,
                    view::show_model(device, painter->model_, painter->light_, {true, true}));
    for (const auto& [tool, drawn] : painter->tools_) {
        BOLT_TRY_ASSIGN(painter->gpu_tools_[tool], render::upload_model(device, drawn.model));
    }
    return painter;
}

// Outlines the part that is turned, turns its hexagon to fit the tool, and lets what hides it fade.
Status JointPainter::show_turned_part(const WrenchRoom& room, render::Scene& scene) const {
    const content::AssemblyJoint& joint = assembly_.joints[room.joint];
    BOLT_TRY_ASSIGN(const auto own, view::nodes_of(model_.model, joint.node));
    std::set<int> turned;
    for (const int node : own)
        if (!room.turned.empty() &&
            content::is_turned_node(joint, model_.model.nodes[static_cast<std::size_t>(node)].name))
            turned.insert(node);
    const glm::mat4 turn(glm::rotate(room.to_assembly, room.turn, Vec3(0.0, 1.0, 0.0)) *
                         glm::inverse(room.to_assembly));
    for (render::Object& object : scene.objects) {
        object.cut = !own.contains(object.node);
        if (!turned.contains(object.node)) continue;
        object.world = turn * object.world;
        object.outline = turned_color;
    }
    const Vec3 middle = room.turned.empty() ? Vec3(0.0) : room.turned.middle();
    const double radius = room.turned.empty() ? 0.02 : glm::length(room.turned.half());
    scene.cut_away = {glm::vec3(room.to_assembly * glm::dvec4(middle, 1.0)), static_cast<float>(radius),
                      1.0F};
    return {};
}

FanRing JointPainter::ring_of(const WrenchRoom& room) const {
    const geometry::ToolShape& tool = rooms_.tools[room.tool];
    return {1.1 * std::hypot(room.turned.half().x, room.turned.half().z), fan_reach * tool.reach,
            room.height + tool.handle_height};
}

PictureContents JointPainter::contents_of(const WrenchRoom& room, const FanRing& ring) const {
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
    const geometry::ToolShape& tool = rooms_.tools[room.tool];
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
    const glm::dmat4 pose = tool_pose(room);
    for (const geometry::Triangle& t : tool.triangles)
        contents.framed.emplace_back(pose * glm::dvec4(t.a, 1.0));
    return contents;
}

void JointPainter::add_labels(const WrenchRoom& room, const FanRing& ring,
                              const std::vector<Blocker>& blockers, render::Scene& scene) const {
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
        if (blocker.total >= least_named && scene.labels.size() < most_names)
            add(blocker.name, blocker.middle, {0.6F, 0.05F, 0.05F, 0.85F});
    if (const geometry::Arc* arc = room.swing.widest())
        add(fmt::format("{:.0f}°", to_degrees(arc->width())), arc->from + 0.25 * arc->width(),
            {0.05F, 0.4F, 0.12F, 0.85F});
}

Result<std::string> JointPainter::draw(const WrenchRoom& room, const std::vector<Blocker>& blockers) {
    gpu::Device& device = *gpu_context_.device;
    render::Scene scene = shown_->scene;
    BOLT_TRY(show_turned_part(room, scene));
    const FanRing ring = ring_of(room);
    render::GpuModel gpu_fan;
    if (room.gripped) {
        const DrawnTool& tool = tools_.at(room.tool);
        render::add_model(scene, tool.model, gpu_tools_.at(room.tool),
                          glm::mat4(tool_pose(room) * tool.from_model));
        const assets::Model fan = make_swing_fan(room.swing, ring);
        BOLT_TRY_ASSIGN(gpu_fan, render::upload_model(device, fan));
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
        add_labels(room, ring, blockers, scene);
    }
    const VkExtent2D size = joint_picture_size;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const view::Orbit orbit = joint_view(rooms_, room, contents_of(room, ring), static_cast<double>(aspect));
    render::BoundingBox box = shown_->box;
    const render::BoundingBox all = render::bounds(scene);
    box.add(all.low);
    box.add(all.high);
    const render::Eye eye = view::eye_of(orbit, box, aspect);
    view::separate_labels(fonts_, scene.labels, eye, glm::vec2(size.width, size.height));
    BOLT_TRY_ASSIGN(
        const auto pictures,
        render::take_pictures(device, *gpu_context_.frames, *gpu_context_.renderer, scene, {&eye, 1}, size));
    return assets::encode_png(static_cast<int>(size.width), static_cast<int>(size.height), 4,
                              pictures.front().rgba);
}

}  // namespace

Status draw_joint_pictures(const content::Assembly& assembly, const WrenchRooms& rooms,
                           const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed)
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be created: {}", folder.string(), failed.message()));
    BOLT_TRY_ASSIGN(const auto painter, JointPainter::create(assembly, rooms));
    for (const WrenchRoom& room : rooms.joints) {
        const std::vector<Blocker> blockers = blockers_of(rooms, room);
        BOLT_TRY_ASSIGN(const auto png, painter->draw(room, blockers));
        const fs::path file = folder / file_name(assembly.joints[room.joint].design.id);
        BOLT_TRY(write_file(file, png));
        const std::string tool = room.tool == 0 ? std::string() : assembly.tools[room.tool].name;
        BOLT_TRY(print(fmt::format("{}: {}\n", file.string(), description(room, blockers, tool))));
    }
    return {};
}

}  // namespace bolt::author
