// A lesson in a headset or between projection walls: where the workpiece and the panel of the user interface
// stand in the room, and the pointer on the panel. Neither moves with the head. Poses are in the room's frame
// (view::ImmersiveFrame) unless a comment says otherwise.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "content/trainee/settings.hpp"
#include "engine/platform/input.hpp"
#include "engine/render/gpu_model.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/scene.hpp"
#include "game/trainer/room_placement.hpp"
#include "game/trainer/touch_check.hpp"
#include "game/view/immersive_frame.hpp"

namespace bolt::trainer {

// The panel shows the same interface as a window, with menus, help and measured values. At 0.75 m a text of
// 15 points has 20 dmm (mm at 1 m), the smallest that reads without effort (Google Daydream's guideline).
inline constexpr glm::dvec2 panel_points{1160.0, 760.0};
inline constexpr double panel_distance = 0.75, point_size = 1.0e-3;  // m
inline constexpr float panel_scale = 1.5F;                           // px per point
inline constexpr VkExtent2D panel_extent{1740, 1140};                // px, panel_points × panel_scale

// Where the panel is pointed at.
struct PanelPointer {
    glm::dvec2 at{0.0};  // px from the upper left corner; keeps the last position
    bool on_panel = false;
    bool pressed = false;
    std::optional<xr::Side> side;  // of the hand that points at it in this frame
};

// Darkens the edge of the view while the scene moves although the head does not: motion at the edge of the
// view makes people sick.
struct Vignette {
    std::optional<Pose> scene;  // of the last frame, in the room
    double strength = 0.0;      // 0 open … 1 closed
};

// The state of a room from frame to frame. It is kept while the display is lost for a short time, so that
// workpiece and panel stay where they are.
struct RoomState {
    std::optional<Pose> workpiece;  // pose of the assembly's frame; none: not placed yet
    // It stands where the station file registers the real workpiece, and is neither turned nor raised.
    bool workpiece_registered = false;
    std::optional<Pose> panel;  // pose of its centre: x right, y up, z towards the user; none: not placed yet
    double panel_point_size = point_size;  // m per point of the panel
    Placement placement;
    PanelPointer pointer;
    // For each hand in the last frame: buttons that were down, and whether the present deflection of the
    // stick has turned the workpiece already.
    std::array<bool, 2> menu_down{}, secondary_down{}, stick_used{};
    std::array<double, 2> menu_held{};  // s for which the menu button has been down, for each hand
    const xr::ControllerProfile* controller = nullptr;  // in a hand in the last frame; null: none is known
    double height = 0.0;                                // m that the user has raised the workpiece
    int turns = 0;                                      // steps by which the user has turned it
    // The arm's frame in the room; none unless the station file registers it and the arm's scale is 1.
    // Without it the workpiece stands where the user looks.
    std::optional<Pose> arm;
    std::uint32_t arm_lesson = 0;     // number of the lesson for which `arm` was set; 0: none
    std::optional<TouchCheck> touch;  // checks the arm's registration before the lesson begins
    bool touch_done = false;          // the check has ended or was skipped since the room's origin moved
    Vignette vignette;
    Pose drawn_scene;                  // pose of the scene's frame in the room, as it was last drawn
    bool has_display = false;          // a headset or walls show this frame
    bool plays_in_room = false;        // the user plays in the room in this frame; false: in the window
    bool seen = false;                 // the user saw the lesson in the last frame
    bool paused = false;               // the lesson is paused because the user does not see it
    std::uint32_t watched_lesson = 0;  // number of the last lesson that was paused or seen
};

// The functions below take the bounding box of the workpiece as `box`, in the assembly's frame.

// The body of the user, as far as the place of the workpiece depends on it.
struct UserBody {
    std::optional<double> seated_eyes;  // m, from the floor to the eyes; none: the floor is that of the room
    double arm_reach = content::usual_arm_reach;
};
// The pose of the workpiece in front of a user who looks straight ahead. Its bench stands on the floor of the
// room, or for a seated user UserBody::seated_eyes below the eyes. Its distance is proportional to the reach.
Pose place_workpiece(const Pose& head, const render::BoundingBox& box, const UserBody& user);

// The pose of the workpiece, moved away from the head by up to 2.5 m until the display shows most corners of
// the box.
Pose moved_into_view(const Pose& workpiece, const render::BoundingBox& box, const Pose& head,
                     const std::function<bool(const Vec3&)>& shows);

// The pose of the panel: in front of the user, upright, a little below the eyes and behind the workpiece.
Pose place_panel(const Pose& head);

// The pose of the workpiece after the user has turned it by `turns` steps about the vertical through its
// middle, and raised it by `height` m.
Pose adjusted(const Pose& workpiece, const render::BoundingBox& box, int turns, double height);
inline constexpr double turn_step = to_radians(30.0);
inline constexpr double raise_step = 0.05;  // m, by a key or a button

// Raises the workpiece, by up to 0.4 m from where it was placed; negative: lowers it.
void raise(RoomState& room, double height);

// The pose of the scene in the room, when the arm's frame is registered to it: the end of the handle is shown
// where the hand is. `arm_in_room`: the registration; `arm_in_scene`: StationTick::mover_in_assembly.
inline Pose registered_scene(const Pose& arm_in_room, const Pose& arm_in_scene) {
    return arm_in_room * inverse(arm_in_scene);
}

// The point, px, where a ray along −z of `aim` meets the panel; none: it does not.
std::optional<glm::dvec2> panel_hit(const view::PanelPlace& panel, const Pose& aim);

// The point of the panel at `at` (px, as panel_hit() returns it), m in the room.
Vec3 point_on_panel(const view::PanelPlace& panel, const glm::dvec2& at);

// The keys that controller buttons trigger.
struct HandKeys {
    platform::Key pause = platform::Key::escape, tool = platform::Key::unknown;
};
// The events of the hands in a frame of `seconds`: pointer and button on the panel, and the keys of the
// buttons. Updates the room: its pointer, its controller, the turns and the height by the sticks, and the
// request to place all again by a menu button that is held for 1 s. The hand `working` does not point: its
// ray crosses the panel by chance, and it closes on a tool.
std::vector<platform::InputEvent> hand_events(RoomState& room, const xr::Hands& hands, const HandKeys& keys,
                                              double seconds, std::optional<xr::Side> working = {});

// The position of an event of the pointer, px; null for other events.
glm::dvec2* pointer_position(platform::InputEvent& event);

// Converts the pointer's positions from window pixels to panel pixels. `shown`: the area of the window that
// shows the panel.
void move_to_panel(std::span<platform::InputEvent> events, const VkRect2D& shown);

// Draws the scene for each group of eyes. `scene_in_room`: the pose of the scene's frame.
Status draw_in_room(render::Renderer& renderer, gpu::FrameContext& frame, const render::Scene& scene,
                    const Pose& scene_in_room, const view::ImmersiveFrame& immersive);

// Updates the poses of the eyes in the draw commands that draw_in_room() has recorded in this frame (late
// update of the head's pose).
void move_eyes_in_room(render::Renderer& renderer, const Pose& scene_in_room,
                       const view::ImmersiveFrame& immersive);

// Call once a frame. The vignette closes within 0.1 s while the scene moves in the room, and opens within 0.4
// s when it stands; a jump of more than 5 cm or 5° is no motion that the user sees.
void update(Vignette& vignette, const Pose& scene_in_room, double seconds);

// Draws the vignette over the pictures of draw_in_room(), around the direction of the head.
Status draw_vignette(render::Renderer& renderer, gpu::FrameContext& frame, const Vignette& vignette,
                     const view::ImmersiveFrame& immersive);

// The panel in the scene, whose frame is `scene_in_room`.
render::Panel panel_in_scene(const view::PanelPlace& panel, const Pose& scene_in_room,
                             const gpu::Image& picture);

}  // namespace bolt::trainer
