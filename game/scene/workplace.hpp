// What there is in a workshop, as entities: plain data, no behaviour. Systems (systems.hpp) move it and
// draw it.
#pragma once

#include <algorithm>
#include <glm/mat4x4.hpp>
#include <memory>
#include <optional>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/render/gpu_model.hpp"
#include "engine/render/scene.hpp"
#include "game/scene/hand_clearance.hpp"
#include "game/session/lesson_session.hpp"
#include "game/view/loaded_model.hpp"
#include "game/world/world.hpp"
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

// Where things and people are before and beside a machine.

// Whoever works: with which hand, and how high.
struct Worker {
    hand::Side side = hand::Side::right;
    std::optional<double> seated_eyes;  // m, of the eyes above the floor; none: standing
};

inline constexpr double floor_below_plate = 0.85;    // m, of the workshop (content/environments)
inline constexpr double shoulders_below_eyes = 0.2;  // m, about what DIN 33402-2 has for those who sit

// Where a wrench lies: before the machine, its handle along x to the side of the hand that takes it, its
// jaw's normal up.
inline Pose resting_place(const render::BoundingBox& machine, double head_thickness,
                          hand::Side side = hand::Side::right) {
    const Vec3 low(machine.low), high(machine.high);
    const Quat round = glm::angleAxis(side == hand::Side::left ? pi : 0.0, Vec3(0, 1, 0));
    return {{0.5 * (low.x + high.x), low.y + 0.5 * head_thickness + 0.002, high.z + 0.06},
            round * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
}

// m, of the eyes of somebody who sits.
inline std::optional<double> eye_level(const render::BoundingBox& machine, const Worker& worker) {
    if (!worker.seated_eyes) return std::nullopt;
    return static_cast<double>(machine.low.y) - floor_below_plate + *worker.seated_eyes;
}

// The shoulder of the hand that works.
inline Vec3 shoulder_at(const render::BoundingBox& machine, const Worker& worker = {}) {
    const Vec3 low(machine.low), high(machine.high);
    Vec3 at = high + Vec3(0.35, 0.3, 0.4);
    if (worker.side == hand::Side::left) at.x = low.x - 0.35;
    if (const auto eyes = eye_level(machine, worker)) at.y = std::min(at.y, *eyes - shoulders_below_eyes);
    return at;
}

// The models of a lesson: the machine, the workshop around it, the wrench and the hand.

// On the CPU. Everything but the machine's own model is optional: what an assembly does not name, or what is
// not installed, is left out and named in `missing`.
struct Shelf {
    view::Subject machine;
    assets::Model workshop, wrench, hand;
    std::optional<shading::RadianceImage> light;
    Quat wrench_turn{1.0, 0.0, 0.0, 0.0};  // from the frame of the wrench's model to the tool's
    std::vector<std::string> missing;
};

Result<Shelf> load_shelf(const content::Assembly& assembly, hand::Side side = hand::Side::right);

// The same on the GPU. Stays where it is made: entities point to the models.
struct GpuShelf {
    render::GpuModel machine, workshop, wrench, hand, arrows;
    render::EnvironmentLight light;
};

Result<std::unique_ptr<GpuShelf>> upload(gpu::Device& device, const Shelf& shelf);

// An assembly in its workshop, as entities.

struct Workplace {
    World world;

    render::BoundingBox machine;  // m, of what is assembled
    glm::dmat4 workshop{1.0};
};

// The machine with its foot on the workshop's clamping plate, nuts where their joints have them, wrench and
// hand. Errors: a joint whose node or nut the model has not.
Result<Workplace> make_workplace(World world, const Shelf& shelf, const GpuShelf& on_gpu,
                                 const content::Assembly& assembly, const servo::Setup& setup);

}  // namespace bolt::scene
