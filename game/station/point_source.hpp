// Sources of the points from which a registration is computed. A source measures, in its own frame, points
// whose positions in the other frame are known.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/base/rigid_alignment.hpp"
#include "haptics/device/device_thread.hpp"

namespace bolt::station_setup {

class PointSource {
  public:
    PointSource() = default;
    PointSource(const PointSource&) = delete;
    PointSource& operator=(const PointSource&) = delete;
    virtual ~PointSource() = default;

    // Measures point `number`, from 0, of `count`, whose position in the other frame is `target`, m. Waits
    // until it is measured. Fails if the source is lost or the user interrupts.
    virtual Result<Vec3> measure(std::size_t number, std::size_t count, const Vec3& target) = 0;
};

// Measures each target.
Result<std::vector<PointPair>> measure_points(PointSource& source, std::span<const Vec3> targets);

struct TouchOptions {
    double duration = 0.3;        // s over which positions are averaged
    double max_motion = 1.0e-3;   // m, largest distance of a position from their mean
    std::size_t min_samples = 5;  // fewer make the touch invalid
    double max_silence = 1.0;     // s without a sample until the device counts as lost
};

// The mean of positions. Fails if the hand moved between them, or if there are too few.
Result<Vec3> average_touch(std::span<const Vec3> positions, const TouchOptions& options = {});

// The functions of the program that a touch calls; tests replace them and run in virtual time.
struct TouchIo {
    std::function<device::DeviceSnapshot()> snapshot;  // the device's latest sample
    std::function<bool()> confirmed;                   // Enter was pressed since the last call
    std::function<bool()> stop;                        // the user ends the program
    std::function<void(std::string_view)> show;        // a line for the user
    device::Timer timer;
};

// The tip of an arm, in the frame of its samples: the user touches each point and presses a button of the arm
// or Enter. The position is averaged; if the hand moved, the user must touch the point again.
class ArmTip final : public PointSource {
  public:
    // `tip`: m, in the frame of the handle.
    ArmTip(TouchIo io, const Vec3& tip, const TouchOptions& options = {});
    Result<Vec3> measure(std::size_t number, std::size_t count, const Vec3& target) override;

    // Shows `request` and waits until point `number`, from 0, is measured.
    Result<Vec3> touch(std::size_t number, std::string_view request);

  private:
    Status wait_for_press();
    Result<std::vector<Vec3>> positions();
    Result<device::DeviceSnapshot> next_snapshot();

    TouchIo io_;
    Vec3 tip_;
    TouchOptions options_;
    std::uint32_t buttons_ = ~0U;  // of the last sample
    std::uint64_t sample_ = 0;     // number of the last sample
    double sample_time_ = 0.0;     // s, when it arrived
};

}  // namespace bolt::station_setup
