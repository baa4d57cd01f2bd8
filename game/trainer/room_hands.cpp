#include "game/trainer/room_hands.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "game/scene/postures.hpp"
#include "game/trainer/tracked_hand.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::trainer {

namespace {

constexpr double ray_radius = 1.5e-3, free_ray = 0.5;  // m; of a ray that does not meet the panel
constexpr glm::vec4 ray_color{0.55F, 0.80F, 1.0F, 1.0F}, pressing_color{1.0F, 0.85F, 0.35F, 1.0F};

glm::dmat4 matrix(const Pose& pose) {
    return glm::translate(glm::dmat4(1.0), pose.position) * glm::mat4_cast(pose.orientation);
}

// A tube of radius 1 from the origin to 1 along +Z.
assets::Model tube() {
    constexpr std::uint32_t sides = 10;
    assets::Primitive mesh;
    for (std::uint32_t i = 0; i <= sides; ++i) {
        const double phi = 2.0 * pi * i / sides;
        const glm::vec3 out(std::cos(phi), std::sin(phi), 0.0);
        for (const float z : {0.0F, 1.0F}) {
            mesh.positions.push_back(out + glm::vec3(0.0F, 0.0F, z));
            mesh.normals.push_back(out);
        }
        if (i == sides) continue;
        const std::uint32_t a = 2 * i;
        for (const std::uint32_t index : {a, a + 2, a + 1, a + 1, a + 2, a + 3})
            mesh.indices.push_back(index);
    }
    mesh.material = 0;
    assets::Model model;
    assets::Material material;
    material.name = "ray";
    model.materials.push_back(material);
    assets::Node node;
    node.name = "ray";
    node.mesh = 0;
    model.nodes.push_back(node);
    model.roots.push_back(0);
    model.meshes.push_back({"ray", {std::move(mesh)}, {}});
    return model;
}

Status load_hand(gpu::Device& device, Side side, RoomHand& hand) {
    const std::filesystem::path file =
        content::content_folder() / (side == Side::left ? "hands/hand_left.glb" : "hands/hand_right.glb");
    const Result<assets::Model> model = assets::read_gltf(file);
    // A lesson reports the missing file.
    if (!model || model->skins.empty()) return {};
    BOLT_TRY_ASSIGN(auto uploaded, render::upload_model(device, *model, {true}));
    hand.model = std::move(uploaded);
    render::Scene scene;
    render::add_model(scene, *model, hand.model);
    hand.objects = std::move(scene.objects);
    hand.inverse_bind = model->skins.front().inverse_bind;
    hand.open = scene::make_postures(nullptr, 0.2, side).open;
    return {};
}

// The joints of the hand in the room: as measured, or of an open hand at the grip pose.
std::optional<hand::Skeleton> joints_of(const RoomHand& model, const xr::HandInput& input, Side side) {
    hand::Skeleton joints = model.open;
    if (input.joints && std::all_of(input.joints->begin(), input.joints->end(),
                                    [](const auto& joint) { return joint.valid; })) {
        for (std::size_t i = 0; i < hand::joint_count; ++i) {
            joints.position[i] = (*input.joints)[i].pose.position;
            joints.rotation[i] = (*input.joints)[i].pose.orientation;
        }
        return joints;
    }
    const std::optional<Pose> palm = palm_of(input, side);
    if (!palm) return std::nullopt;
    const Pose open_palm{model.open.position[hand::palm], model.open.rotation[hand::palm]};
    const Pose frame = *palm * fingertips_at_palm(side) * palm_joint_at_fingertips(side) * inverse(open_palm);
    for (std::size_t i = 0; i < hand::joint_count; ++i) {
        const Pose joint = frame * Pose{joints.position[i], joints.rotation[i]};
        joints.position[i] = joint.position;
        joints.rotation[i] = joint.orientation;
    }
    return joints;
}

void add_hand(render::Scene& scene, const RoomHand& model, const hand::Skeleton& joints,
              const Pose& room_in_scene) {
    auto deformation = std::make_shared<render::Deformation>();
    for (std::size_t i = 0; i < model.inverse_bind.size() && i < hand::joint_count; ++i)
        deformation->joints.push_back(glm::mat4(matrix({joints.position[i], joints.rotation[i]})) *
                                      model.inverse_bind[i]);
    for (render::Object object : model.objects) {
        object.world = glm::mat4(matrix(room_in_scene));
        object.deformation = deformation;
        object.moves = true;
        scene.objects.push_back(std::move(object));
    }
}

}  // namespace

PointingRay pointing_ray(const RoomState& room, const Pose& aim, bool pressed) {
    PointingRay ray{aim.position, aim * Vec3(0.0, 0.0, -free_ray), pressed};
    if (!room.panel) return ray;
    const view::PanelPlace panel{*room.panel, room.panel_point_size};
    if (const auto at = panel_hit(panel, aim)) ray.to = point_on_panel(panel, *at);
    return ray;
}

Result<render::GpuModel> load_ray(gpu::Device& device) { return render::upload_model(device, tube()); }

void add_ray(render::Scene& scene, const render::GpuModel& model, const PointingRay& pointing,
             const Pose& room_in_scene) {
    const Vec3 from = room_in_scene * pointing.from, to = room_in_scene * pointing.to;
    const double length = glm::distance(from, to);
    if (length < 1e-3) return;
    const Vec3 z = (to - from) / length;
    const Vec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.9 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), z));
    render::Object ray;
    ray.model = &model;
    ray.world =
        glm::mat4(glm::dmat4(glm::dvec4(ray_radius * x, 0.0), glm::dvec4(ray_radius * glm::cross(z, x), 0.0),
                             glm::dvec4(length * z, 0.0), glm::dvec4(from, 1.0)));
    ray.tint = pointing.pressed ? pressing_color : ray_color;
    ray.flat = ray.moves = true;
    scene.objects.push_back(ray);
}

Result<std::unique_ptr<RoomHandModels>> load_room_hands(gpu::Device& device) {
    auto models = std::make_unique<RoomHandModels>();
    for (const Side side : {Side::left, Side::right})
        BOLT_TRY(load_hand(device, side, models->hands[static_cast<std::size_t>(side)]));
    BOLT_TRY_ASSIGN(auto ray, load_ray(device));
    models->ray = std::move(ray);
    return models;
}

void add_room_hands(render::Scene& scene, const RoomHandModels& models, const xr::Hands& hands,
                    const RoomState& room, const Pose& scene_in_room, const ShownHands& shown) {
    const Pose room_in_scene = inverse(scene_in_room);
    for (const Side side : {Side::left, Side::right}) {
        const xr::HandInput& hand = hands[side];
        const bool points = room.pointer.on_panel && room.pointer.side == side;
        if (!hand.active || !(shown.all || points)) continue;
        const RoomHand& model = models.hands[static_cast<std::size_t>(side)];
        if (shown.by_lesson != side)
            if (const auto joints = joints_of(model, hand, side))
                add_hand(scene, model, *joints, room_in_scene);
        if (!hand.aim) continue;
        add_ray(scene, models.ray, pointing_ray(room, hand.aim->pose, points && room.pointer.pressed),
                room_in_scene);
    }
}

void add_menu_light(render::Scene& scene) {
    scene.lights.push_back(view::key_light());
    render::SceneLight fill = view::key_light();
    fill.light.direction = -fill.light.direction;
    fill.casts_shadow = false;
    scene.lights.push_back(fill);
}

}  // namespace bolt::trainer
