// The user's hands and pointing rays in a room, where the lesson does not draw them: in the menu, in a pause,
// and while a hand points at the panel.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "engine/render/gpu_model.hpp"
#include "engine/render/scene.hpp"
#include "engine/xr/input.hpp"
#include "game/trainer/room_state.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::trainer {

// A hand on the GPU. Scenes point to the model, so it must not be moved.
struct RoomHand {
    render::GpuModel model;
    std::vector<render::Object> objects;  // of the model in its rest pose
    std::vector<glm::mat4> inverse_bind;  // of the model's joints
    hand::Skeleton open;                  // an open hand, drawn if the joints are not measured
};

struct RoomHandModels {
    std::array<RoomHand, 2> hands;  // by Side; without objects if its model cannot be read
    render::GpuModel ray;
};
Result<std::unique_ptr<RoomHandModels>> load_room_hands(gpu::Device& device);

// The line along which a hand or a wand points, m in the room. It ends on the panel if it meets it.
struct PointingRay {
    Vec3 from{0.0}, to{0.0};
    bool pressed = false;
};
PointingRay pointing_ray(const RoomState& room, const Pose& aim, bool pressed);

// The model of a ray, and a ray in the scene. The scene points to the model.
Result<render::GpuModel> load_ray(gpu::Device& device);
void add_ray(render::Scene& scene, const render::GpuModel& model, const PointingRay& ray,
             const Pose& room_in_scene);

// The sides that are drawn.
struct ShownHands {
    bool all = false;                   // all active hands; else the one that points at the panel
    std::optional<xr::Side> by_lesson;  // the lesson draws this one; its ray is drawn all the same
};

// Adds hands and rays to the scene whose frame is `scene_in_room`.
void add_room_hands(render::Scene& scene, const RoomHandModels& models, const xr::Hands& hands,
                    const RoomState& room, const Pose& scene_in_room, const ShownHands& shown);

// The lights of a scene without a workshop, for the hands in the menu.
void add_menu_light(render::Scene& scene);

}  // namespace bolt::trainer
