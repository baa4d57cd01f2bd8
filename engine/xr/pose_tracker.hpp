// The pose of a headset, a controller or a Vive tracker, without pictures in a headset (XR_MND_headless): the
// head of a viewer of projection walls, or the device that measures the points of a registration.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/base/tracker_role.hpp"

namespace bolt::xr {

// The headset, or the grip pose of a controller, for example of one that is fixed to the viewer's glasses.
enum class TrackedDevice : std::uint8_t { headset, left_controller, right_controller };

class PoseTracker {
  public:
    // Fails with ErrorCode::no_device if there is no runtime, it cannot track without pictures, or nothing is
    // connected; trying again later may then succeed.
    static Result<std::unique_ptr<PoseTracker>> open(TrackedDevice device);
    // Opens the Vive tracker with this role. Also fails if the runtime lacks the extension or the role. A
    // tracker that is switched off, or gets the role later, is no error.
    static Result<std::unique_ptr<PoseTracker>> open(TrackerRole role);
    PoseTracker(const PoseTracker&) = delete;
    PoseTracker& operator=(const PoseTracker&) = delete;
    ~PoseTracker();

    // The pose now, m, x right, y up: in the runtime's stage or, if there is no stage, in its local space.
    // None: the device is not tracked now. Fails if the runtime has ended; the tracker must then be
    // destroyed.
    Result<std::optional<Pose>> read();

    // The reason for which the last read() returned no pose of a Vive tracker; empty for other devices, and
    // before the runtime has begun the session.
    [[nodiscard]] const std::string& fault() const;

    // True if the trigger of the controller, or its button that selects, was pressed at the last read(). A
    // Vive tracker has no button.
    [[nodiscard]] bool pressed() const;

    // True if the poses are those in the stage, which is fixed in the room.
    [[nodiscard]] bool in_stage() const;

    // The number of times that the user or the runtime has moved the origin of the poses.
    [[nodiscard]] std::uint32_t origin_moves() const;

  private:
    struct Objects;
    explicit PoseTracker(std::unique_ptr<Objects> objects);
    std::unique_ptr<Objects> objects_;
};

}  // namespace bolt::xr
