#include "haptics/device/recorded.hpp"

#include <utility>

namespace bolt::device {

namespace {

class Recorded final : public Device {
  public:
    Recorded(Description description, Recording recording, Timer timer)
        : description_(std::move(description)),
          recording_(std::move(recording)),
          timer_(std::move(timer)),
          next_(recording_(0)) {
        if (next_) start_ = timer_.now() - next_->time;
    }

    [[nodiscard]] const Description& describe() const override { return description_; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double until = timer_.now() + timeout;
        const double due = next_ ? start_ + next_->time : last_.time + 1.0 / description_.rate;
        if (due > until) {
            timer_.wait(timeout);
            return std::optional<Sample>{};
        }
        if (due > timer_.now()) timer_.wait(due - timer_.now());
        const double now = timer_.now();
        if (!next_) last_.buttons = 0, last_.velocity = last_.angular_velocity = Vec3(0.0);
        // If several samples are due, return the latest, as a device does that is polled late.
        while (next_ && start_ + next_->time <= now) {
            last_ = *next_;
            next_ = recording_(++index_);
        }
        last_.time = now;
        return last_;
    }

    Status write(const force::OutputCommand& /*command*/) override { return {}; }

  private:
    Description description_;
    Recording recording_;
    Timer timer_;
    std::optional<Sample> next_;
    std::size_t index_ = 0;
    double start_ = 0.0;  // s of the clock at the recording's time 0
    Sample last_;
};

}  // namespace

DeviceFactory recorded(Description description, Recording recording, Timer timer) {
    return [description = std::move(description), recording = std::move(recording),
            timer = std::move(timer)]() -> Result<std::unique_ptr<Device>> {
        if (!recording(0))
            return fail(ErrorCode::failed, "the recording has no samples", "a session with ticks");
        return std::make_unique<Recorded>(description, recording, timer);
    };
}

}  // namespace bolt::device
