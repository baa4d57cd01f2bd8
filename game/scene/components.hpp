// What there is in a workshop, as entities: plain data, no behaviour. Systems (systems.hpp) move it and
// draw it.
#pragma once

#include <glm/mat4x4.hpp>
#include <memory>

#include "engine/render/scene.hpp"
#include "game/scene/hand_clearance.hpp"
#include "game/world/components.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

// Where an entity is: its own frame to the assembly's.
struct Placement {
    glm::mat4 world{1.0F};
};

// What is drawn of it.
struct Drawn {
    const render::GpuModel* model = nullptr;
    std::uint32_t mesh = 0;
    int node = -1;       // of the model that it came from
    bool moves = false;  // stands in the shadow map anew each frame
};

// A nut: goes round and down with its joint.
struct Nut {
    std::size_t joint = 0;
    glm::dmat4 own_from_mesh{1.0};  // the mesh's frame to the nut's own (servo::nut_pose)
};

// Belongs to a joint: its bolt, its washers, its nut.
struct OfJoint {
    std::size_t joint = 0;
};

// Goes with the wrench.
struct OnTool {
    glm::dmat4 tool_from_mesh{1.0};
};

// The hand that is shown, bent as it is.
struct Fingers {
    hand::Skeleton shown;  // in the frame of the tool
    std::vector<glm::mat4> inverse_bind;
    std::shared_ptr<const render::Deformation> deformation;
    float strain = 0.0F;          // 0 … 1: its skin pales
    float too_near = 0.0F;        // 0 … 1: its arm is so near to the eye that it fills the picture
    hand::Skeleton posture = {};  // what `shown` departs from, to stay out of solids
    std::shared_ptr<const std::vector<SkinPoint>> skin = nullptr;
    HandClearance clearance = {};
};

// A line around it, through whatever hides it.
struct Outlined {
    glm::vec4 color{0.0F};
};

// Only an image of what should be there: the wrench on its nut, the hand at it.
struct Ghost {
    glm::dmat4 tool_from_mesh{1.0};
    bool shown = false;
};

// Shows a motion (arrow.hpp).
enum class ArrowShape : std::uint8_t { straight, round };
struct Pointer {
    ArrowShape shape = ArrowShape::straight;
    bool shown = false;
    glm::vec4 color{1.0F};
};

// Fades where it hides what must be seen.
struct CanFade {
    bool fades = true;
};

// The work and its pictures in one registry.
using World =
    world::WorldWith<Placement, Drawn, Nut, OfJoint, OnTool, Fingers, Outlined, Ghost, Pointer, CanFade>;

}  // namespace bolt::scene
