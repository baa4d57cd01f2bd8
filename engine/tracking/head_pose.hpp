// From the pose of a tracked body in the tracker's frame to the pose of the head in the room.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::tracking {

// The pose of the head is that of the point between the eyes, which looks along −z with y up.
struct TrackerRegistration {
    Quat axes{1.0, 0.0, 0.0, 0.0};  // rotation from the tracker's axes to the room's: its x, y and z renamed
    double scale = 1.0;             // m of the room per m of the tracker
    Pose tracker_in_room;           // after both
    Pose head_in_body;              // in the body, after its axes are renamed
};

inline Pose head_in_room(const TrackerRegistration& registration, const Pose& body) {
    const Quat& axes = registration.axes;
    const Pose renamed{axes * (registration.scale * body.position),
                       axes * body.orientation * glm::conjugate(axes)};
    Pose head = registration.tracker_in_room * renamed * registration.head_in_body;
    head.orientation = glm::normalize(head.orientation);
    return head;
}

}  // namespace bolt::tracking
