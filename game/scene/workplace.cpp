#include "game/scene/workplace.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "game/scene/angle_dial.hpp"
#include "game/scene/annotations.hpp"
#include "game/session/contact_models.hpp"
#include "game/tool_models/tool_model.hpp"

namespace bolt::scene {

namespace {

// Reads a model; on failure returns an empty one and adds the error message to `missing`.
assets::Model read_optional(const std::filesystem::path& file, std::vector<std::string>& missing) {
    Result<assets::Model> model = assets::read_gltf(file);
    if (model) return std::move(*model);
    missing.push_back(model.error().message());
    return {};
}

// Reads the pictures of the author's instructions.
void load_pictures(const content::Assembly& assembly, LessonModels& models) {
    for (const auto* passes : {&assembly.passes, &assembly.loosening})
        for (const content::Pass& pass : *passes) {
            const std::string& file = pass.instruction.picture;
            if (file.empty() || models.pictures.contains(file)) continue;
            const Result<std::string> bytes =
                read_file(file, content::largest_picture_file, ErrorCode::bad_content);
            assets::Bitmap picture;
            if (bytes) picture.encoded.assign(bytes->begin(), bytes->end());
            const Status decoded = bytes ? assets::decode(picture) : Status(fail(bytes.error()));
            if (decoded)
                models.pictures.emplace(file, std::move(picture));
            else
                models.missing.push_back(fmt::format("{}: {}", file, decoded.error().message()));
        }
}

Result<gpu::Image> upload_picture(gpu::Device& device, const assets::Bitmap& picture) {
    const auto pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    const auto channels = static_cast<std::size_t>(picture.channels);
    std::vector<std::byte> texels(4 * pixels, std::byte{255});
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t c = 0; c < std::size_t{3}; ++c)
            texels[4 * i + c] = std::byte{picture.pixels[channels * i + (channels < 3 ? 0 : c)]};
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R8G8B8A8_SRGB;
    info.extent = {static_cast<std::uint32_t>(picture.width), static_cast<std::uint32_t>(picture.height)};
    info.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    info.array = true;
    BOLT_TRY_ASSIGN(auto image, gpu::Image::create(device, info));
    BOLT_TRY(gpu::upload_image(device, image, texels));
    BOLT_TRY(gpu::submit_and_wait(device, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, image.get(), gpu::ResourceUse::sampled, gpu::ResourceUse::transfer_from);
    }));
    return image;
}

}  // namespace

Result<LessonModels> load_lesson_models(const content::Assembly& assembly, hand::Side side) {
    LessonModels models;
    view::ModelLoadResult workpiece =
        view::load_model(assembly.file, view::DetailLevel::near, assembly.variant);
    if (!workpiece.ok()) return fail(workpiece.errors.front());
    models.workpiece = std::move(workpiece.model);
    const std::filesystem::path content = content::content_folder();
    models.workshop = read_optional(content / "environments/workshop.glb", models.missing);
    models.hand =
        read_optional(content / (side == hand::Side::left ? "hands/hand_left.glb" : "hands/hand_right.glb"),
                      models.missing);
    for (const content::WrenchDesign* design :
         content::designs_of(assembly, content::lesson_tools(assembly))) {
        ToolModel& tool = models.tools.emplace_back();
        if (design->model.empty()) {
            tool.model = tool_models::drawn_model(tool_models::parameters_of(*design));
        } else {
            tool.model = read_optional(design->model, models.missing);
            BOLT_TRY_ASSIGN(const auto turn, session::wrench_rotation(*design));
            tool.turn = turn;
        }
    }
    for (const content::AssemblyJoint& joint : assembly.joints) {
        if (joint.design.counter_hold == joint::CounterHold::fixed) continue;
        const double size = joint::held_part_size(joint.design).across_flats;
        if (models.second_wrenches.contains(size)) continue;
        BOLT_TRY_ASSIGN(const auto ring, tool_models::completed({tool_models::ModelKind::ring_wrench, size}));
        models.second_wrenches.emplace(size, tool_models::drawn_model(ring));
    }
    models.dial_windows = dial_windows(assembly);
    models.dial = dial_model(models.dial_windows);
    load_pictures(assembly, models);
    Result<shading::RadianceImage> light = assets::read_hdr(content / "environments/workshop.hdr");
    if (light)
        models.light = std::move(*light);
    else
        models.missing.push_back(light.error().message());
    return models;
}

Result<std::unique_ptr<GpuLessonModels>> upload(gpu::Device& device, const LessonModels& models) {
    auto uploaded = std::make_unique<GpuLessonModels>();
    const auto upload_to = [&](const assets::Model& model, render::GpuModel& to) -> Status {
        if (model.meshes.empty()) return {};
        BOLT_TRY_ASSIGN(auto gpu_model, render::upload_model(device, model, {true}));
        to = std::move(gpu_model);
        return {};
    };
    for (const auto& [model, to] : {std::pair{&models.workpiece.model, &uploaded->workpiece},
                                    {&models.workshop, &uploaded->workshop},
                                    {&models.hand, &uploaded->hand},
                                    {&models.dial, &uploaded->dial}})
        BOLT_TRY(upload_to(*model, *to));
    uploaded->tools.resize(models.tools.size());
    for (std::size_t i = 0; i < models.tools.size(); ++i)
        BOLT_TRY(upload_to(models.tools[i].model, uploaded->tools[i]));
    for (const auto& [size, model] : models.second_wrenches)
        BOLT_TRY(upload_to(model, uploaded->second_wrenches[size]));
    BOLT_TRY(upload_to(arrow_model(), uploaded->arrows));
    for (const auto& [file, picture] : models.pictures) {
        BOLT_TRY_ASSIGN(auto image, upload_picture(device, picture));
        uploaded->pictures.emplace(file, std::move(image));
    }
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(
                                    device, models.light ? *models.light : shading::studio_environment()));
    uploaded->light = std::move(light);
    return uploaded;
}

namespace {

constexpr std::size_t clearance_points = 320;  // skin points of the hand that stay out of solids

glm::dmat4 matrix(const Quat& turn) { return glm::mat4_cast(turn); }

// The joint of each node; −1: none.
std::vector<int> joints_of(const assets::Model& model, const content::Assembly& assembly) {
    std::vector<int> joints(model.nodes.size(), -1);
    for (std::size_t j = 0; j < assembly.joints.size(); ++j)
        for (std::size_t n = 0; n < model.nodes.size(); ++n) {
            if (assembly.joints[j].node.empty() || model.nodes[n].name != assembly.joints[j].node) continue;
            std::vector<int> pending{static_cast<int>(n)};
            while (!pending.empty()) {
                const auto node = static_cast<std::size_t>(pending.back());
                pending.pop_back();
                joints[node] = static_cast<int>(j);
                pending.insert(pending.end(), model.nodes[node].children.begin(),
                               model.nodes[node].children.end());
            }
        }
    return joints;
}

std::vector<glm::dvec3> points_of(const assets::Mesh& mesh, const glm::mat4& world) {
    std::vector<glm::dvec3> points;
    for (const assets::Primitive& p : mesh.primitives)
        for (const glm::vec3& at : p.positions) points.emplace_back(glm::dmat4(world) * glm::dvec4(at, 1.0));
    return points;
}

// HeldPart::corner.
double corner_of(const assets::Mesh& mesh, const glm::mat4& world, servo::NutGeometry held) {
    held.across_flats = held.held_across_flats;
    held.socket_depth = 0.0;
    const Quat straighten = session::find_hexagon(held, points_of(mesh, world)).straighten;
    return -2.0 * std::atan2(straighten.z, straighten.w);
}

// From the mesh's frame to the nut's, determined from the corners of the hexagon (session::find_hexagon).
glm::dmat4 nut_from_mesh(const assets::Mesh& mesh, const glm::mat4& world, const servo::NutGeometry& nut) {
    const session::HexagonPose hexagon = session::find_hexagon(nut, points_of(mesh, world));
    const auto to_nut = [&](const Vec3& p) { return session::to_nut_frame(nut, hexagon, p); };
    const Vec3 origin = to_nut(Vec3(0.0));
    glm::dmat4 from_assembly(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0.0);
        unit[axis] = 1.0;
        from_assembly[axis] = glm::dvec4(to_nut(unit) - origin, 0.0);
    }
    from_assembly[3] = glm::dvec4(origin, 1.0);
    return from_assembly * glm::dmat4(world);
}

Status add_workpiece(Workplace& workplace, const LessonModels& models, const GpuLessonModels& on_gpu,
                     const content::Assembly& assembly, const servo::Setup& setup) {
    const assets::Model& model = models.workpiece.model;
    render::Scene scene;
    render::add_model(scene, model, on_gpu.workpiece);
    workplace.workpiece = render::bounds(scene);
    const std::vector<int> joints = joints_of(model, assembly);
    std::vector<bool> has_nut(setup.nuts.size(), false);
    for (const render::Object& object : scene.objects) {
        const ecs::Entity entity = view::add_drawable(workplace.world, object);
        workplace.world.add<Fadable>(entity, true);
        const auto node = static_cast<std::size_t>(object.node);
        if (joints[node] < 0) continue;
        const auto joint = static_cast<std::size_t>(joints[node]);
        workplace.world.add<JointPart>(entity, joint);
        if (content::is_held_node(assembly.joints[joint], model.nodes[node].name)) {
            workplace.world.add<HeldPart>(
                entity, joint, glm::dmat4(object.world),
                corner_of(model.meshes[object.mesh], object.world, setup.nuts[joint]));
            workplace.world.get<Drawable>(entity).moves = true;
        }
        if (!content::is_turned_node(assembly.joints[joint], model.nodes[node].name)) continue;
        workplace.world.add<NutPart>(
            entity, joint, nut_from_mesh(model.meshes[object.mesh], object.world, setup.nuts[joint]));
        workplace.world.get<Drawable>(entity).moves = true;
        has_nut[joint] = true;
    }
    for (std::size_t i = 0; i < has_nut.size(); ++i)
        if (!has_nut[i])
            return fail(ErrorCode::bad_content,
                        fmt::format("{}: the model lacks the part of joint {} that is turned", assembly.file,
                                    assembly.joints[i].design.id),
                        fmt::format("a node \"{}\" below the joint's node",
                                    content::turned_node(assembly.joints[i])));
    return {};
}

void add_workshop(Workplace& workplace, const LessonModels& models, const GpuLessonModels& on_gpu) {
    const glm::vec3 foot(0.5F * (workplace.workpiece.low.x + workplace.workpiece.high.x),
                         workplace.workpiece.low.y,
                         0.5F * (workplace.workpiece.low.z + workplace.workpiece.high.z));
    workplace.workshop = glm::translate(glm::dmat4(1.0), Vec3(foot));
    if (models.workshop.meshes.empty()) return;
    render::Scene scene;
    render::add_model(scene, models.workshop, on_gpu.workshop, glm::mat4(workplace.workshop));
    for (const render::Object& object : scene.objects) (void)view::add_drawable(workplace.world, object);
}

// The parts of a ratchet that do not turn with its handle, by the names of their nodes: socket, bit,
// extension bar (bar_…) and square drive.
bool is_in_ratchet_head(const assets::Model& model, int node) {
    if (node < 0) return false;
    const std::string& name = model.nodes[static_cast<std::size_t>(node)].name;
    return name == "drive" || name == "bit" || name.starts_with("socket") || name.starts_with("bar_");
}

std::optional<tool_models::DisplayElement> display_element(const assets::Model& model, int node) {
    if (node < 0) return std::nullopt;
    return tool_models::display_element(model.nodes[static_cast<std::size_t>(node)].name);
}

void add_tool(Workplace& workplace, std::size_t index, const ToolModel& tool,
              const render::GpuModel& on_gpu) {
    if (tool.model.meshes.empty()) return;
    render::Scene scene;
    render::add_model(scene, tool.model, on_gpu);
    for (const render::Object& object : scene.objects) {
        const ecs::Entity entity = view::add_drawable(workplace.world, object);
        workplace.world.get<Drawable>(entity).moves = true;
        const glm::dmat4 tool_from_mesh = matrix(tool.turn) * glm::dmat4(object.world);
        const auto display = display_element(tool.model, object.node);
        workplace.world.add<ToolPart>(entity, tool_from_mesh, index,
                                      is_in_ratchet_head(tool.model, object.node), display);
        if (display) continue;  // a ghost of the tool measures nothing
        const ecs::Entity ghost = view::add_drawable(workplace.world, object);
        workplace.world.get<Drawable>(ghost).moves = true;
        workplace.world.add<GhostPart>(ghost, tool_from_mesh, false, index);
    }
}

void add_second_wrench(Workplace& workplace, double size, const assets::Model& model,
                       const render::GpuModel& on_gpu) {
    render::Scene scene;
    render::add_model(scene, model, on_gpu);
    for (const render::Object& object : scene.objects) {
        const ecs::Entity entity = view::add_drawable(workplace.world, object);
        workplace.world.get<Drawable>(entity).moves = true;
        workplace.world.add<SecondWrenchPart>(entity, glm::dmat4(object.world), size);
        workplace.world.add<Appearance>(entity).hidden = true;
    }
}

void add_hand(Workplace& workplace, const LessonModels& models, const GpuLessonModels& on_gpu) {
    if (models.hand.skins.empty()) return;
    const auto skin =
        std::make_shared<const std::vector<SkinPoint>>(sample_skin(models.hand, clearance_points));
    render::Scene scene;
    render::add_model(scene, models.hand, on_gpu.hand);
    for (const render::Object& object : scene.objects) {
        const ecs::Entity entity = view::add_drawable(workplace.world, object);
        workplace.world.get<Drawable>(entity).moves = true;
        workplace.world.add<Fadable>(entity, true);
        workplace.world
            .add<SkinnedHand>(entity, hand::Skeleton{}, models.hand.skins.front().inverse_bind, nullptr)
            .skin = skin;
        const ecs::Entity ghost = view::add_drawable(workplace.world, object);
        workplace.world.get<Drawable>(ghost).moves = true;
        workplace.world.add<SkinnedHand>(ghost, hand::Skeleton{}, models.hand.skins.front().inverse_bind,
                                         nullptr);
        workplace.world.add<GhostPart>(ghost, glm::dmat4(1.0), false);
    }
}

void add_arrows(Workplace& workplace, const GpuLessonModels& on_gpu) {
    constexpr std::pair<ArrowShape, ArrowMeaning> arrows[] = {{ArrowShape::straight, ArrowMeaning::motion},
                                                              {ArrowShape::round, ArrowMeaning::motion},
                                                              {ArrowShape::straight, ArrowMeaning::force}};
    for (const auto& [shape, meaning] : arrows) {
        const ecs::Entity entity = workplace.world.create();
        workplace.world.add<Transform>(entity);
        workplace.world.add<Drawable>(entity, &on_gpu.arrows, static_cast<std::uint32_t>(shape), -1, true);
        workplace.world.add<ArrowMarker>(entity, shape, meaning);
    }
}

void add_dial(Workplace& workplace, const LessonModels& models, const GpuLessonModels& on_gpu) {
    if (models.dial_windows.empty()) return;
    std::uint32_t mesh = 0;
    const auto add = [&](DialShape shape, const DialWindow& window) {
        const ecs::Entity entity = workplace.world.create();
        workplace.world.add<Transform>(entity);
        workplace.world.add<Drawable>(entity, &on_gpu.dial, mesh++, -1, true);
        workplace.world.add<DialMarker>(entity, shape, window);
    };
    add(DialShape::scale, {});
    add(DialShape::pointer, {});
    for (const DialWindow& window : models.dial_windows) add(DialShape::window, window);
}

}  // namespace

Result<Workplace> make_workplace(SceneWorld world, const LessonModels& models, const GpuLessonModels& on_gpu,
                                 const content::Assembly& assembly, const servo::Setup& setup) {
    Workplace workplace;
    workplace.world = std::move(world);
    BOLT_TRY(add_workpiece(workplace, models, on_gpu, assembly, setup));
    add_workshop(workplace, models, on_gpu);
    for (std::size_t i = 0; i < models.tools.size(); ++i)
        add_tool(workplace, i, models.tools[i], on_gpu.tools[i]);
    for (const auto& [size, model] : models.second_wrenches)
        add_second_wrench(workplace, size, model, on_gpu.second_wrenches.at(size));
    add_hand(workplace, models, on_gpu);
    add_arrows(workplace, on_gpu);
    add_dial(workplace, models, on_gpu);
    return workplace;
}

}  // namespace bolt::scene
