// Converts the pose of a tracked body in the tracker's frame to the pose of the head in the room.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::tracking {

// Pose of a tracked body in the tracker's frame at a time, s, on any steady clock.
struct BodySample {
    double time = 0.0;
    Pose pose;
};

// The transform from the tracker's frame to the room, and from the tracked body to the head. The pose of the
// head is at the point between the eyes, and the head looks along −z with y up.
struct TrackerRegistration {
    Quat axes_rotation{1.0, 0.0, 0.0, 0.0};  // from the tracker's axes to axes that point like the room's
    double scale = 1.0;                      // m of the room per m of the tracker
    Pose tracker_in_room;  // pose of the tracker's frame; applied after `axes_rotation` and `scale`
    Pose head_in_body;     // in the body's frame after `axes_rotation`
};

inline Pose head_in_room(const TrackerRegistration& registration, const Pose& body) {
    const Quat& rotation = registration.axes_rotation;
    const Pose rotated{rotation * (registration.scale * body.position),
                       rotation * body.orientation * glm::conjugate(rotation)};
    Pose head = registration.tracker_in_room * rotated * registration.head_in_body;
    head.orientation = glm::normalize(head.orientation);
    return head;
}

}  // namespace bolt::tracking
