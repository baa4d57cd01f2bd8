#include "haptics/device/simulated.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace bolt::device {

namespace {

constexpr double longest_step = 0.5e-3;  // s
constexpr double forgets = 0.05;         // s after which nobody watched: the hand is where it means to be

tl::unexpected<Error> gone(const Description& description) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = description.name + " is not plugged in";
    error.expected = "plug it in";
    error.lost = true;
    return fail(std::move(error));
}

}  // namespace

class Simulated::Plug final : public Device {
  public:
    explicit Plug(Simulated& thing) : thing_(thing), due_(thing.timer_.now()) {}
    Plug(const Plug&) = delete;
    Plug& operator=(const Plug&) = delete;
    ~Plug() override { thing_.command_ = {}; }

    [[nodiscard]] const Description& describe() const override { return thing_.design_.description; }

    Result<std::optional<Sample>> read(double patience) override {
        wait_if_stuck();
        const double until = thing_.timer_.now() + patience;
        if (thing_.befallen(Mishap::silent) || due_ > until) {
            thing_.timer_.wait(patience);
            if (thing_.cut()) return gone(describe());
            return std::optional<Sample>{};
        }
        thing_.timer_.wait(due_ - thing_.timer_.now());
        if (thing_.cut()) return gone(describe());
        thing_.advance();
        // What is late is not made up for.
        due_ = std::max(due_, thing_.now_.time - 1.0 / describe().rate) + 1.0 / describe().rate;
        Sample sample = thing_.now_;
        if (thing_.befallen(Mishap::no_number))
            sample.pose.position.y = sample.velocity.y = sample.turn =
                std::numeric_limits<double>::quiet_NaN();
        if (thing_.befallen(Mishap::jumped)) {
            sample.pose.position += Vec3(0.5, 0.0, 0.0);
            sample.turn += 3.0;
        }
        return sample;
    }

    Status write(const force::OutputCommand& command) override {
        wait_if_stuck();
        if (thing_.befallen(Mishap::slow)) thing_.timer_.wait(slow_write);
        if (thing_.cut()) return gone(describe());
        thing_.advance();
        const force::OutputLimits& limits = describe().limits;
        thing_.command_ = {force::at_most(command.force, limits.force),
                           force::at_most(command.torque, limits.torque)};
        return {};
    }

  private:
    void wait_if_stuck() {
        while (const Trouble* stuck = thing_.find(Mishap::stuck))
            thing_.timer_.wait(stuck->until - thing_.timer_.now() + 1e-9);
    }

    Simulated& thing_;
    double due_;  // s, of the next sample
};

Simulated::Simulated(SimulatedDesign design, Timer timer)
    : design_(std::move(design)), timer_(std::move(timer)) {
    time_ = timer_.now();
    advance();
}

Open Simulated::open() {
    return [this]() -> Result<std::unique_ptr<Device>> {
        if (cut()) return gone(design_.description);
        advance();
        return std::make_unique<Plug>(*this);
    };
}

void Simulated::happen(const Trouble& trouble) {
    std::erase_if(design_.troubles, [now = timer_.now()](const Trouble& t) { return t.until < now; });
    design_.troubles.push_back(trouble);
}

const Trouble* Simulated::find(Mishap what) const {
    const double now = timer_.now();
    const auto found = std::find_if(design_.troubles.begin(), design_.troubles.end(), [&](const Trouble& t) {
        return t.what == what && t.from <= now && now < t.until;
    });
    return found == design_.troubles.end() ? nullptr : &*found;
}

bool Simulated::befallen(Mishap what) const { return find(what) != nullptr; }

// Without power motors also forget what they were told.
bool Simulated::cut() {
    if (!befallen(Mishap::unplugged)) return false;
    command_ = {};
    return true;
}

force::OutputCommand Simulated::rendered() const {
    return befallen(Mishap::unplugged) ? force::OutputCommand{} : command_;
}

// Where the hand has got to until now.
void Simulated::advance() {
    const double now = timer_.now();
    if (!design_.hand || !begun_ || now - time_ > forgets) {
        now_ = design_.script(now);
        velocity_ = angular_velocity_ = Vec3(0.0);
        turn_rate_ = 0.0;
        begun_ = true;
    } else if (now > time_) {
        const auto steps = static_cast<int>(std::ceil((now - time_) / longest_step));
        const double dt = (now - time_) / steps;
        const Sample meant = design_.script(now);
        for (int i = 0; i < steps; ++i) step(meant, dt);
        now_.velocity = meant.velocity;
        now_.angular_velocity = meant.angular_velocity;
        now_.buttons = meant.buttons;
    }
    time_ = now_.time = now;
}

// Semi-implicit, stable far beyond these springs at this step.
void Simulated::step(const Sample& meant, double dt) {
    const HoldingHand& hand = *design_.hand;
    const force::OutputCommand force = rendered();
    if (design_.description.sensing == Sensing::turn) {
        const double torque = hand.torsion * (meant.turn - now_.turn) - hand.angular_damping * turn_rate_ +
                              glm::dot(force.torque, design_.description.axis);
        turn_rate_ += torque / hand.inertia * dt;
        now_.turn += turn_rate_ * dt;
        return;
    }
    const Vec3 push = hand.stiffness * (meant.pose.position - now_.pose.position) - hand.damping * velocity_;
    velocity_ += (push + force.force) / hand.mass * dt;
    now_.pose.position += velocity_ * dt;
    const Vec3 off =
        rotation_vector(glm::normalize(meant.pose.orientation * glm::conjugate(now_.pose.orientation)));
    const Vec3 twist = hand.torsion * off - hand.angular_damping * angular_velocity_;
    angular_velocity_ += (twist + force.torque) / hand.inertia * dt;
    now_.pose.orientation = glm::normalize(rotation(angular_velocity_ * dt) * now_.pose.orientation);
}

}  // namespace bolt::device
