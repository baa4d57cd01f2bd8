// When workpiece and panel of a room get their places, and when they are placed again. They never follow the
// head: each placing is one step, after which they stay where they are.
#pragma once

#include <optional>

#include "game/view/immersive_frame.hpp"

namespace bolt::trainer {

// Kept from frame to frame.
struct Placement {
    double waited = 0.0;           // s for which the user has looked while nothing was placed
    double unseen = 0.0;           // s for which the user has turned away from the panel
    bool provisional = false;      // placed for a head that was lower than any person's
    bool workpiece_faced = false;  // the user has faced the workpiece since it was placed
    bool requested = false;        // by the user: place all again
};

// The places of a frame, in the room: the pose of the panel and the middle of the workpiece. None: not
// placed.
struct PlacedObjects {
    std::optional<Pose> panel;
    std::optional<Vec3> workpiece;
};

// The objects that are to be placed again.
struct ObjectsToPlace {
    bool panel = false, workpiece = false;
};

// True if the head is that of a person who wears the headset: tracked, attentive, and 0.9 m above the floor
// or higher, if the floor is known. A headset that lies on a table is lower.
bool is_worn(const view::ImmersiveFrame& immersive);

// True if panel and workpiece can be placed for the head of this frame, or if the display has an expected
// head. After 3 s of an attentive head that is too low they are placed all the same, because the floor may be
// set wrongly.
bool can_place(const Placement& placement, const view::ImmersiveFrame& immersive);

// Call once a frame, of `seconds`. All is placed again when the user requests it or recentres the headset,
// and when a head at a plausible height follows one that was too low. When the user has turned away from the
// panel for 3 s, or has gone away, the panel is placed again, and so is a workpiece that the user has never
// faced. A workpiece that was faced stays: the user may walk around it. A display that is fixed in the room
// keeps all where it is.
ObjectsToPlace update(Placement& placement, const view::ImmersiveFrame& immersive,
                      const PlacedObjects& placed, double seconds);

}  // namespace bolt::trainer
