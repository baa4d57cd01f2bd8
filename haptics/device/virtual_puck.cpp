#include "haptics/device/virtual_puck.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/triple_buffer.hpp"

namespace bolt::device {

namespace {

struct Pushed {
    PuckInput push;
    double time = 0.0;  // s
};

Vec3 faster(const Vec3& share, double fastest) {
    Vec3 speed(0.0);
    for (int i = 0; i < 3; ++i) {
        const double s = std::clamp(share[i], -1.0, 1.0);
        speed[i] = fastest * s * std::abs(s);
    }
    return speed;
}

}  // namespace

struct VirtualPuck::Shared {
    VirtualPuckOptions options;
    Timer timer;
    Description description;
    TripleBuffer<Pushed> pushes;
};

namespace {

template <class Shared>
class Opened final : public Device {
  public:
    explicit Opened(std::shared_ptr<Shared> shared) : shared_(std::move(shared)) {}

    [[nodiscard]] const Description& describe() const override { return shared_->description; }

    Result<std::optional<Sample>> read(double timeout) override {
        const double period = 1.0 / shared_->options.rate;
        const double due = last_ + period - shared_->timer.now();
        shared_->timer.wait(std::clamp(due, 0.0, timeout));
        if (due > timeout) return std::optional<Sample>{};
        Sample sample;
        sample.time = last_ = shared_->timer.now();
        shared_->pushes.update();
        const Pushed& pushed = shared_->pushes.latest();
        if (sample.time - pushed.time < shared_->options.input_timeout) {
            sample.velocity = faster(pushed.push.along, shared_->options.speed);
            sample.angular_velocity = faster(pushed.push.about, shared_->options.angular_speed);
            sample.buttons = pushed.push.buttons;
        }
        return sample;
    }

    Status write(const force::OutputCommand& /*command*/) override { return {}; }

  private:
    std::shared_ptr<Shared> shared_;
    double last_ = 0.0;  // s
};

}  // namespace

VirtualPuck::VirtualPuck(const VirtualPuckOptions& options, Timer timer)
    : shared_(std::make_shared<Shared>()) {
    shared_->options = options;
    shared_->timer = std::move(timer);
    shared_->pushes.write({{}, shared_->timer.now() - options.input_timeout});
    Description& d = shared_->description;
    d.name = "mouse and keyboard";
    d.id = "puck";
    d.sensing = Sensing::rate;
    d.limits.force = d.limits.torque = 0.0;
    d.rate = options.rate;
    d.buttons = 32;
}
VirtualPuck::VirtualPuck(VirtualPuck&&) noexcept = default;
VirtualPuck& VirtualPuck::operator=(VirtualPuck&&) noexcept = default;
VirtualPuck::~VirtualPuck() = default;

void VirtualPuck::set_input(const PuckInput& push) { shared_->pushes.write({push, shared_->timer.now()}); }

DeviceFactory VirtualPuck::open() {
    return [shared = shared_]() -> Result<std::unique_ptr<Device>> {
        return std::make_unique<Opened<Shared>>(shared);
    };
}

}  // namespace bolt::device
