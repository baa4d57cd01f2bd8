// Devices for tests of the code that uses devices.
#pragma once

#include <atomic>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::test {

inline device::Description arm() {
    device::Description arm;
    arm.name = "an arm";
    arm.id = "arm-1";
    arm.renders.fill(true);
    arm.half_workspace = Vec3(0.2);
    arm.buttons = 2;
    return arm;
}

// Records the writes to an Obedient device, which returns a sample per millisecond. Not thread-safe.
struct Written {
    device::Description description = arm();
    std::vector<force::OutputCommand> commands;
    std::vector<double> began;  // s, start of each write
    double write_takes = 0.0;   // s, duration of a write
    bool fails_reading = false, fails_writing = false;
    int closed = 0;
};

class Obedient final : public device::DeviceDriver {
  public:
    Obedient(std::shared_ptr<Written> state, device::Timer timer)
        : state_(std::move(state)), timer_(std::move(timer)) {}
    Obedient(const Obedient&) = delete;
    Obedient& operator=(const Obedient&) = delete;
    ~Obedient() override { ++state_->closed; }

    [[nodiscard]] const device::Description& description() const override { return state_->description; }

    Result<std::optional<device::Sample>> read(double timeout) override {
        if (state_->fails_reading) return lost();
        timer_.wait(std::min(timeout, 1e-3));
        device::Sample sample;
        sample.time = timer_.now();
        return sample;
    }
    Status write(const force::OutputCommand& command) override {
        if (state_->fails_writing) return lost();
        state_->began.push_back(timer_.now());
        timer_.wait(state_->write_takes);
        state_->commands.push_back(command);
        return {};
    }

  private:
    static tl::unexpected<Error> lost() {
        Error error;
        error.code = ErrorCode::no_device;
        error.what = "pulled";
        error.lost = true;
        return fail(error);
    }

    std::shared_ptr<Written> state_;
    device::Timer timer_;
};

inline device::DeviceFactory opens(std::shared_ptr<Written> state, device::Timer timer) {
    return [state = std::move(state),
            timer = std::move(timer)]() -> Result<std::unique_ptr<device::DeviceDriver>> {
        return std::make_unique<Obedient>(state, timer);
    };
}

}  // namespace bolt::test
