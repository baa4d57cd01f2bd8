// One picture frame of a display that surrounds the user: a headset, or projection walls. Poses are in the
// room's coordinates: x to the right, y up, z towards the user's first position, m.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/renderer.hpp"
#include "engine/xr/headset.hpp"

namespace bolt::view {

// Views of one size: the eyes of a headset, or those in front of one wall.
struct EyeGroup {
    VkExtent2D size{};
    std::vector<render::Eye> eyes;
};

// The place of a panel in the room.
struct PanelPlace {
    Pose pose;                // of its centre: x right, y up, z towards the viewer
    double point_size = 0.0;  // m per point of the panel
};

struct ImmersiveFrame {
    Pose head;
    bool tracked = false;  // false: the pose is an old or an estimated one
    // The headset's runtime is late: poses and hands are those of the last frame, and nothing is drawn.
    bool repeated = false;
    bool attentive = false;  // false: the user does not see the picture; pause, and output no force
    // Workpiece and panel are placed for this pose of the head if the display has fixed walls. None:
    // they are placed for the tracked head.
    std::optional<Pose> expected_head;
    // Returns true if the display shows a point of the room to the expected head; empty: it shows all points.
    std::function<bool(const Vec3&)> shows;
    // Where a display with fixed walls shows the panel; none: in front of the head.
    std::optional<PanelPlace> panel;
    bool recentred = false;     // the user has recentred the headset since the last frame
    bool origin_moved = false;  // the room's origin has moved; a headset may recentre without that
    bool floor_known = true;    // y is 0 at the floor; false: at the eyes of a seated user
    bool fixed_in_room = true;  // the origin stays when the user recentres; false: registrations do not hold
    // Group i is drawn as the renderer's group immersive_group + i; a group without eyes is not drawn.
    std::vector<EyeGroup> groups;
    xr::Hands hands;
    bool has_passthrough = false;  // shows the real room where the picture is transparent
    // A headset, whose tracked hands can move the tool; false: projection walls, whose only hand may be a
    // wand that points.
    bool tracks_hands = false;
    std::function<void(xr::Side, const xr::Vibration&)> vibrate;  // may be empty
};

inline constexpr std::uint32_t immersive_group = 16;
// m. The near plane is nearer than the eyes can focus.
inline constexpr xr::DepthRange immersive_range{0.03F, 50.0F};

// The eyes of a headset, for pictures of this size.
EyeGroup eye_group(const xr::HeadView& view, VkExtent2D size);

// Makes the frame that the headset shows, without groups. `headset` must outlive it.
ImmersiveFrame immersive_frame(xr::Headset& headset, const xr::HeadsetFrame& frame);

// The part of a picture of this size that fills a window of `window`'s shape, in the middle.
VkRect2D filling_part(VkExtent2D picture, VkExtent2D window);

// The largest rectangle with the picture's shape in the middle of a window of this size.
VkRect2D fitted(VkExtent2D picture, VkExtent2D window);

// The pictures of a headset that its window shows to the instructor: copies, so that the window costs no
// drawing.
enum class Mirror : std::uint8_t {
    left_eye,
    right_eye,
    both_eyes,  // side by side
    panel,      // the left eye, and beside it the panel of the interface
};
constexpr std::size_t mirror_count = 4;
// The names in the order of the enumerators, as for `--mirror`.
inline constexpr std::array<std::string_view, mirror_count> mirror_names{"left", "right", "both", "panel"};

struct MirrorSources {
    std::vector<render::ImageLayer> eyes;     // left, right; at least one
    VkExtent2D eye_size{};                    // px, of each eye's picture
    std::optional<render::ImageLayer> panel;  // none: there is no panel now
    VkExtent2D panel_size{};                  // px
};
// The pictures for a window of this size, with their places in it. Shows the left eye if the picture that the
// mirror needs is missing.
std::vector<gpu::ShownPicture> mirror_pictures(Mirror mirror, const MirrorSources& sources,
                                               VkExtent2D window);

}  // namespace bolt::view
