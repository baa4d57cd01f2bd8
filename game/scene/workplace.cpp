#include "game/scene/workplace.hpp"

#include <fmt/format.h>

#include <glm/gtc/matrix_transform.hpp>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "game/scene/annotations.hpp"
#include "game/session/contact_models.hpp"

namespace bolt::scene {

namespace {

// What is on the shelf, or its name under what is missing.
assets::Model read_or_miss(const std::filesystem::path& file, std::vector<std::string>& missing) {
    Result<assets::Model> model = assets::read_gltf(file);
    if (model) return std::move(*model);
    missing.push_back(model.error().message());
    return {};
}

}  // namespace

Result<Shelf> load_shelf(const content::Assembly& assembly, hand::Side side) {
    Shelf shelf;
    view::LoadedSubject machine = view::load_subject(assembly.file);
    if (!machine.ok()) return fail(machine.errors.front());
    shelf.machine = std::move(machine.subject);
    const std::filesystem::path content = content::content_folder();
    shelf.workshop = read_or_miss(content / "environments/workshop.glb", shelf.missing);
    shelf.hand = read_or_miss(
        content / (side == hand::Side::left ? "hands/hand_left.glb" : "hands/hand_right.glb"), shelf.missing);
    if (!assembly.wrench.model.empty()) {
        shelf.wrench = read_or_miss(assembly.wrench.model, shelf.missing);
        BOLT_TRY_ASSIGN(const auto turn, session::wrench_turn(assembly.wrench));
        shelf.wrench_turn = turn;
    }
    Result<shading::RadianceImage> light = assets::read_hdr(content / "environments/workshop.hdr");
    if (light)
        shelf.light = std::move(*light);
    else
        shelf.missing.push_back(light.error().message());
    return shelf;
}

Result<std::unique_ptr<GpuShelf>> upload(gpu::Device& device, const Shelf& shelf) {
    auto on = std::make_unique<GpuShelf>();
    const auto put = [&](const assets::Model& model, render::GpuModel& to) -> Status {
        if (model.meshes.empty()) return {};
        BOLT_TRY_ASSIGN(auto up, render::upload_model(device, model, {true}));
        to = std::move(up);
        return {};
    };
    for (const auto& [model, to] : {std::pair{&shelf.machine.model, &on->machine},
                                    {&shelf.workshop, &on->workshop},
                                    {&shelf.wrench, &on->wrench},
                                    {&shelf.hand, &on->hand}})
        BOLT_TRY(put(*model, *to));
    BOLT_TRY(put(arrow_model(), on->arrows));
    BOLT_TRY_ASSIGN(auto light,
                    render::upload_environment(device, shelf.light ? *shelf.light : shading::studio()));
    on->light = std::move(light);
    return on;
}

namespace {

constexpr std::size_t clearance_points = 320;  // of the hand's skin, kept out of solids

glm::dmat4 matrix(const Quat& turn) { return glm::mat4_cast(turn); }

// Joint of each node, −1: of none.
std::vector<int> joints_of(const assets::Model& model, const content::Assembly& assembly) {
    std::vector<int> joints(model.nodes.size(), -1);
    for (std::size_t j = 0; j < assembly.joints.size(); ++j)
        for (std::size_t n = 0; n < model.nodes.size(); ++n) {
            if (assembly.joints[j].node.empty() || model.nodes[n].name != assembly.joints[j].node) continue;
            std::vector<int> waiting{static_cast<int>(n)};
            while (!waiting.empty()) {
                const auto node = static_cast<std::size_t>(waiting.back());
                waiting.pop_back();
                joints[node] = static_cast<int>(j);
                waiting.insert(waiting.end(), model.nodes[node].children.begin(),
                               model.nodes[node].children.end());
            }
        }
    return joints;
}

// From a nut's mesh to its own frame, read off its corners (play/hexagon_lie.hpp).
glm::dmat4 own_from_mesh(const assets::Mesh& mesh, const glm::mat4& world, const servo::NutGeometry& nut) {
    std::vector<glm::dvec3> points;
    for (const assets::Primitive& p : mesh.primitives)
        for (const glm::vec3& at : p.positions) points.emplace_back(glm::dmat4(world) * glm::dvec4(at, 1.0));
    const session::HexagonLie lie = session::lie_of(nut, points);
    const auto own = [&](const Vec3& p) { return session::to_own_frame(nut, lie, p); };
    const Vec3 origin = own(Vec3(0.0));
    glm::dmat4 from_assembly(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 unit(0.0);
        unit[axis] = 1.0;
        from_assembly[axis] = glm::dvec4(own(unit) - origin, 0.0);
    }
    from_assembly[3] = glm::dvec4(origin, 1.0);
    return from_assembly * glm::dmat4(world);
}

ecs::Entity add(World& world, const render::Object& object) {
    const ecs::Entity entity = world.create();
    world.add<Placement>(entity, object.world);
    world.add<Drawn>(entity, object.model, object.mesh, object.node, false);
    return entity;
}

Status add_machine(Workplace& place, const Shelf& shelf, const GpuShelf& on_gpu,
                   const content::Assembly& assembly, const servo::Setup& setup) {
    const assets::Model& model = shelf.machine.model;
    render::Scene rest;
    render::add_model(rest, model, on_gpu.machine);
    place.machine = render::bounds(rest);
    const std::vector<int> joints = joints_of(model, assembly);
    std::vector<bool> has_nut(setup.nuts.size(), false);
    for (const render::Object& object : rest.objects) {
        const ecs::Entity entity = add(place.world, object);
        place.world.add<CanFade>(entity, true);
        const auto node = static_cast<std::size_t>(object.node);
        if (joints[node] < 0) continue;
        const auto joint = static_cast<std::size_t>(joints[node]);
        place.world.add<OfJoint>(entity, joint);
        if (model.nodes[node].name != assembly.joints[joint].design.id + "_nut") continue;
        place.world.add<Nut>(entity, joint,
                             own_from_mesh(model.meshes[object.mesh], object.world, setup.nuts[joint]));
        place.world.get<Drawn>(entity).moves = true;
        has_nut[joint] = true;
    }
    for (std::size_t i = 0; i < has_nut.size(); ++i)
        if (!has_nut[i])
            return fail(
                ErrorCode::bad_content,
                fmt::format("{}: joint {} has no nut to turn in the model", assembly.file,
                            assembly.joints[i].design.id),
                fmt::format("a node \"{}_nut\" below the joint's node", assembly.joints[i].design.id));
    return {};
}

void add_workshop(Workplace& place, const Shelf& shelf, const GpuShelf& on_gpu) {
    const glm::vec3 foot(0.5F * (place.machine.low.x + place.machine.high.x), place.machine.low.y,
                         0.5F * (place.machine.low.z + place.machine.high.z));
    place.workshop = glm::translate(glm::dmat4(1.0), Vec3(foot));
    if (shelf.workshop.meshes.empty()) return;
    render::Scene rest;
    render::add_model(rest, shelf.workshop, on_gpu.workshop, glm::mat4(place.workshop));
    for (const render::Object& object : rest.objects) add(place.world, object);
}

void add_wrench(Workplace& place, const Shelf& shelf, const GpuShelf& on_gpu) {
    if (shelf.wrench.meshes.empty()) return;
    render::Scene rest;
    render::add_model(rest, shelf.wrench, on_gpu.wrench);
    for (const render::Object& object : rest.objects) {
        const ecs::Entity entity = add(place.world, object);
        place.world.get<Drawn>(entity).moves = true;
        const glm::dmat4 tool_from_mesh = matrix(shelf.wrench_turn) * glm::dmat4(object.world);
        place.world.add<OnTool>(entity, tool_from_mesh);
        const ecs::Entity ghost = add(place.world, object);
        place.world.get<Drawn>(ghost).moves = true;
        place.world.add<Ghost>(ghost, tool_from_mesh, false);
    }
}

void add_hand(Workplace& place, const Shelf& shelf, const GpuShelf& on_gpu) {
    if (shelf.hand.skins.empty()) return;
    const auto skin =
        std::make_shared<const std::vector<SkinPoint>>(spread_skin_points(shelf.hand, clearance_points));
    render::Scene rest;
    render::add_model(rest, shelf.hand, on_gpu.hand);
    for (const render::Object& object : rest.objects) {
        const ecs::Entity entity = add(place.world, object);
        place.world.get<Drawn>(entity).moves = true;
        place.world.add<CanFade>(entity, true);
        place.world.add<Fingers>(entity, hand::Skeleton{}, shelf.hand.skins.front().inverse_bind, nullptr)
            .skin = skin;
        const ecs::Entity ghost = add(place.world, object);
        place.world.get<Drawn>(ghost).moves = true;
        place.world.add<Fingers>(ghost, hand::Skeleton{}, shelf.hand.skins.front().inverse_bind, nullptr);
        place.world.add<Ghost>(ghost, glm::dmat4(1.0), false);
    }
}

void add_arrows(Workplace& place, const GpuShelf& on_gpu) {
    for (const ArrowShape shape : {ArrowShape::straight, ArrowShape::round}) {
        const ecs::Entity entity = place.world.create();
        place.world.add<Placement>(entity);
        place.world.add<Drawn>(entity, &on_gpu.arrows, static_cast<std::uint32_t>(shape), -1, true);
        place.world.add<Pointer>(entity, shape);
    }
}

}  // namespace

Result<Workplace> make_workplace(World world, const Shelf& shelf, const GpuShelf& on_gpu,
                                 const content::Assembly& assembly, const servo::Setup& setup) {
    Workplace place;
    place.world = std::move(world);
    BOLT_TRY(add_machine(place, shelf, on_gpu, assembly, setup));
    add_workshop(place, shelf, on_gpu);
    add_wrench(place, shelf, on_gpu);
    add_hand(place, shelf, on_gpu);
    add_arrows(place, on_gpu);
    return place;
}

}  // namespace bolt::scene
