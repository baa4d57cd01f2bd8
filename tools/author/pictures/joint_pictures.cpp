#include "tools/author/pictures/joint_pictures.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/render/renderer.hpp"
#include "engine/text/fonts.hpp"
#include "game/view/camera.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/labels.hpp"
#include "game/view/shown_model.hpp"
#include "tools/author/pictures/room_drawing.hpp"

namespace bolt::author {

namespace {

namespace fs = std::filesystem;
using geometry::DrawnToolRoom;
using geometry::DrawnToolRooms;

constexpr glm::vec4 turned_color{1.0F, 0.78F, 0.1F, 1.0F};

// A file name for any id.
std::string file_name(std::string id) {
    for (char& c : id)
        if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '_';
    if (id.starts_with('.')) id.front() = '_';
    return id + ".png";
}

// Draws one picture after the other.
class JointPainter {
  public:
    static Result<std::unique_ptr<JointPainter>> create(const content::Assembly& assembly,
                                                        const DrawnToolRooms& rooms);

    // Returns the bytes of a PNG file.
    Result<std::string> draw(const DrawnToolRoom& room, const std::vector<Blocker>& blockers);

    ~JointPainter() {
        if (gpu_context_.device) (void)gpu_context_.device->idle();
    }
    JointPainter(const JointPainter&) = delete;
    JointPainter& operator=(const JointPainter&) = delete;

  private:
    JointPainter(const content::Assembly& assembly, const DrawnToolRooms& rooms)
        : assembly_(assembly), rooms_(rooms) {}

    Status show_turned_part(const DrawnToolRoom& room, render::Scene& scene) const;

    const content::Assembly& assembly_;
    const DrawnToolRooms& rooms_;
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
                                                           const DrawnToolRooms& rooms) {
    std::unique_ptr<JointPainter> painter(new JointPainter(assembly, rooms));
    view::ModelLoadResult loaded = view::load_model(assembly.file, view::DetailLevel::near, assembly.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    painter->model_ = std::move(loaded.model);
    for (const DrawnToolRoom& room : rooms.joints) {
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
Status JointPainter::show_turned_part(const DrawnToolRoom& room, render::Scene& scene) const {
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

Result<std::string> JointPainter::draw(const DrawnToolRoom& room, const std::vector<Blocker>& blockers) {
    gpu::Device& device = *gpu_context_.device;
    render::Scene scene = shown_->scene;
    BOLT_TRY(show_turned_part(room, scene));
    render::GpuModel gpu_fan;
    if (room.gripped) {
        const DrawnTool& tool = tools_.at(room.tool);
        render::add_model(scene, tool.model, gpu_tools_.at(room.tool),
                          glm::mat4(tool_pose(room, room.handle) * tool.from_model));
        const assets::Model fan = make_swing_fan(room.swing, ring_of(rooms_, room));
        BOLT_TRY_ASSIGN(gpu_fan, render::upload_model(device, fan));
        add_fan(scene, fan, gpu_fan, room);
        add_room_labels(scene, rooms_, room, blockers);
    }
    const VkExtent2D size = joint_picture_size;
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    const view::Orbit orbit = joint_view(rooms_, room, static_cast<double>(aspect));
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

Status draw_joint_pictures(const content::Assembly& assembly, const DrawnToolRooms& rooms,
                           const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed)
        return fail(ErrorCode::failed,
                    fmt::format("{} cannot be created: {}", folder.string(), failed.message()),
                    "a folder that this user may write to");
    BOLT_TRY_ASSIGN(const auto painter, JointPainter::create(assembly, rooms));
    for (const DrawnToolRoom& room : rooms.joints) {
        const std::vector<Blocker> blockers = blockers_of(rooms, room);
        BOLT_TRY_ASSIGN(const auto png, painter->draw(room, blockers));
        const fs::path file = folder / file_name(assembly.joints[room.joint].design.id);
        BOLT_TRY(write_file(file, png));
        const std::string tool = room.tool == 0 ? std::string() : assembly.tools[room.tool].name;
        BOLT_TRY(print(fmt::format("{}: {}\n", file.string(), describe_room(room, blockers, tool))));
    }
    return {};
}

}  // namespace bolt::author
