// The components and models of a workplace: the workpiece in its workshop, the wrench and the hand. Plain
// data; the systems (systems.hpp) move and draw it.
#pragma once

#include <algorithm>
#include <glm/mat4x4.hpp>
#include <map>
#include <memory>
#include <optional>

#include "content/format/assembly.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "game/scene/hand_clearance.hpp"
#include "game/session/lesson_session.hpp"
#include "game/tool_models/display.hpp"
#include "game/view/drawables.hpp"
#include "game/view/loaded_model.hpp"
#include "game/world/world.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

using view::Appearance;
using view::Drawable;
using view::Fadable;
using view::Outline;
using view::Transform;

// A nut, which turns and advances with its joint.
struct NutPart {
    std::size_t joint = 0;
    glm::dmat4 nut_from_mesh{1.0};  // from the mesh's frame to the nut's (servo::nut_pose)
};

// A part of a joint: bolt, washer or nut.
struct JointPart {
    std::size_t joint = 0;
};

// The part of a joint that a second wrench holds, which turns with the nut if nothing holds it.
struct HeldPart {
    std::size_t joint = 0;
    glm::dmat4 assembly_from_mesh{1.0};
    // rad about the joint's axis, from servo::NutGeometry::e1 to a corner of the part's hexagon, before it
    // turns
    double corner = 0.0;
};

// A part of a second wrench. Only the wrench with the size of the held part is drawn.
struct SecondWrenchPart {
    glm::dmat4 tool_from_mesh{1.0};
    double across_flats = 0.0;  // m, of the held part that the wrench fits
};

// A part of a tool, which moves with it. Only the parts of the tool in use are drawn.
struct ToolPart {
    glm::dmat4 tool_from_mesh{1.0};
    std::size_t tool = 0;  // index in servo::Setup::tools
    bool in_head = false;  // turns with the head of a ratchet, not with its handle
    std::optional<tool_models::DisplayElement> display;  // set for a part of a torque wrench's display
};

// The displayed hand.
struct SkinnedHand {
    hand::Skeleton shown;  // in the frame of the tool
    std::vector<glm::mat4> inverse_bind;
    std::shared_ptr<const render::Deformation> deformation;
    float effort = 0.0F;          // 0 … 1: pallor of the skin
    float nearness = 0.0F;        // 0 … 1: fades an arm near to the eye
    hand::Skeleton posture = {};  // before the correction that keeps the hand out of solids
    std::shared_ptr<const std::vector<SkinPoint>> skin = nullptr;
    HandClearance clearance = {};
    double nut_share = 1.0;  // 1: drawn as it works on a nut; 0: as it is measured (ToolAndHand::palm)
};

// A transparent wrench or hand that demonstrates a pose.
struct GhostPart {
    glm::dmat4 tool_from_mesh{1.0};
    bool shown = false;
    std::size_t tool = 0;  // of a wrench: index in servo::Setup::tools
};

// An arrow that demonstrates a motion, or the force on the hand (annotations.hpp).
enum class ArrowShape : std::uint8_t { straight, round };
enum class ArrowMeaning : std::uint8_t { motion, force };
struct ArrowMarker {
    ArrowShape shape = ArrowShape::straight;
    ArrowMeaning meaning = ArrowMeaning::motion;
    bool shown = false;
    glm::vec4 color{1.0F};
};

// A part of the protractor at a nut that is turned by an angle (angle_dial.hpp).
enum class DialShape : std::uint8_t { scale, pointer, window };
// The angles between which to stop, rad from the mark, clockwise seen from the side of the tool: negative at
// a left-hand thread.
struct DialWindow {
    double low = 0.0, high = 0.0;
    friend bool operator==(const DialWindow&, const DialWindow&) = default;
};
struct DialMarker {
    DialShape shape = DialShape::scale;
    DialWindow window;  // of DialShape::window
    bool shown = false;
    glm::vec4 color{1.0F};
};

// The registry with the components of the simulation and of its pictures.
using SceneWorld =
    world::WorldWith<Transform, Drawable, Appearance, Outline, Fadable, NutPart, JointPart, HeldPart,
                     ToolPart, SecondWrenchPart, SkinnedHand, GhostPart, ArrowMarker, DialMarker>;

// The properties of the person at the workplace that the scene depends on.
struct Worker {
    hand::Side side = hand::Side::right;  // the working hand
    std::optional<double> seated_eyes;    // m, height of the eyes above the floor; none: standing
};

// m, depth of the floor below the clamping plate (content/environments)
inline constexpr double floor_below_plate = 0.85;
inline constexpr double shoulders_below_eyes = 0.2;  // m, sitting; about the value of DIN 33402-2

// The rest pose of a wrench: in front of the workpiece, the handle along x towards the side of the working
// hand, the jaw's normal up.
inline Pose wrench_rest_pose(const render::BoundingBox& workpiece, double head_thickness,
                             hand::Side side = hand::Side::right) {
    const Vec3 low(workpiece.low), high(workpiece.high);
    const Quat half_turn = glm::angleAxis(side == hand::Side::left ? pi : 0.0, Vec3(0, 1, 0));
    return {{0.5 * (low.x + high.x), low.y + 0.5 * head_thickness + 0.002, high.z + 0.06},
            half_turn * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
}

// Height of the worker's eyes in the assembly's frame, m; none if standing.
inline std::optional<double> eye_height(const render::BoundingBox& workpiece, const Worker& worker) {
    if (!worker.seated_eyes) return std::nullopt;
    return static_cast<double>(workpiece.low.y) - floor_below_plate + *worker.seated_eyes;
}

// Position of the working hand's shoulder, m, assembly frame.
inline Vec3 shoulder_position(const render::BoundingBox& workpiece, const Worker& worker = {}) {
    const Vec3 low(workpiece.low), high(workpiece.high);
    Vec3 at = high + Vec3(0.35, 0.3, 0.4);
    if (worker.side == hand::Side::left) at.x = low.x - 0.35;
    if (const auto eyes = eye_height(workpiece, worker)) at.y = std::min(at.y, *eyes - shoulders_below_eyes);
    return at;
}

// The model of a tool, and the rotation from its frame to the tool's.
struct ToolModel {
    assets::Model model;
    Quat turn{1.0, 0.0, 0.0, 0.0};
};

// The models of a lesson on the CPU. Workshop, hand, light and pictures are optional: one that cannot be read
// is empty and listed in `missing`. A tool without a file is generated (game/tool_models).
struct LessonModels {
    view::LoadedModel workpiece;
    assets::Model workshop, hand;
    assets::Model dial;                               // angle_dial.hpp; empty if no nut is turned by an angle
    std::vector<DialWindow> dial_windows;             // of the dial's meshes
    std::vector<ToolModel> tools;                     // in the order of content::LessonTools
    std::map<double, assets::Model> second_wrenches;  // by width across flats, m
    std::optional<shading::RadianceImage> light;
    std::map<std::string, assets::Bitmap> pictures;  // of the author's instructions, decoded, by path
    std::vector<std::string> missing;                // error messages
};

Result<LessonModels> load_lesson_models(const content::Assembly& assembly,
                                        hand::Side side = hand::Side::right);

// The models of a lesson on the GPU. Entities point to them, so they must not be moved.
struct GpuLessonModels {
    render::GpuModel workpiece, workshop, hand, arrows, dial;
    std::vector<render::GpuModel> tools;
    std::map<double, render::GpuModel> second_wrenches;
    render::EnvironmentLight light;
    std::map<std::string, gpu::Image>
        pictures;  // in ResourceUse::transfer_from, as ui::Ui::picture needs them
};

Result<std::unique_ptr<GpuLessonModels>> upload(gpu::Device& device, const LessonModels& models);

struct Workplace {
    SceneWorld world;

    render::BoundingBox workpiece;  // m, of the assembly
    glm::dmat4 workshop{1.0};       // from the workshop's frame to the assembly's
};

// Creates the entities in `world`, the workpiece on the workshop's clamping plate. Fails if the model lacks
// the node of a joint or of a nut.
Result<Workplace> make_workplace(SceneWorld world, const LessonModels& models, const GpuLessonModels& on_gpu,
                                 const content::Assembly& assembly, const servo::Setup& setup);

}  // namespace bolt::scene
