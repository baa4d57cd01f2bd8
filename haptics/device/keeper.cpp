#include "haptics/device/keeper.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::device {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool finite(const force::OutputCommand& c) { return finite(c.force) && finite(c.torque); }

bool renders(const Description& d) {
    return std::any_of(d.renders.begin(), d.renders.end(), [](bool axis) { return axis; });
}

// What the device described, whatever was asked for.
force::OutputCommand within(const Description& d, force::OutputCommand command) {
    for (int i = 0; i < 3; ++i) {
        if (!d.renders[static_cast<std::size_t>(i)]) command.force[i] = 0.0;
        if (!d.renders[static_cast<std::size_t>(i) + 3]) command.torque[i] = 0.0;
    }
    return {force::at_most(command.force, d.limits.force), force::at_most(command.torque, d.limits.torque)};
}

}  // namespace

Keeper::Keeper(Open open, Timer timer, const KeeperOptions& options)
    : open_(std::move(open)), timer_(std::move(timer)), options_(options), pause_(options.first_pause) {
    next_try_ = timer_.now();
}

Keeper::~Keeper() { close(); }

bool Keeper::must_speak() const {
    return report_.description->sensing != Sensing::rate && !report_.description->rests;
}

bool Keeper::sound(const Sample& s) const {
    switch (report_.description->sensing) {
        case Sensing::pose:
            return finite(s.pose.position) &&
                   std::abs(glm::dot(s.pose.orientation, s.pose.orientation) - 1.0) < 1e-2;
        case Sensing::rate:
            return finite(s.velocity) && finite(s.angular_velocity);
        case Sensing::turn:
            return std::isfinite(s.turn);
    }
    return false;
}

bool Keeper::try_open(std::uint64_t number) {
    Result<std::unique_ptr<Device>> opened = open_();
    const double now = timer_.now();
    next_try_ = now + pause_;
    pause_ = std::min(2.0 * pause_, options_.longest_pause);
    if (!opened) {
        ++report_.refusals;
        report_.trouble = opened.error().message();
        return false;
    }
    ++report_.openings;
    device_ = std::move(*opened);
    report_.description = std::make_shared<const Description>(device_->describe());
    // A period, so that what is wanted of the device waits no longer for what it says.
    const double period = 1.0 / std::clamp(report_.description->rate, 1.0, 1e4);
    patience_ = std::clamp(period, 1e-3, renders(*report_.description) ? 2e-3 : 10e-3);
    heard_ = now;
    order_ = number;
    ordered_ = now - options_.stale;
    forced_ = true;  // whoever had it before may have left it so
    rendering_ = false;
    report_.state = State::silent;
    if (!must_speak()) {
        report_.state = State::usable;
        report_.trouble.clear();
    }
    return true;
}

void Keeper::close() {
    if (!device_) return;
    // An error says that it cannot be told any more.
    if (renders(*report_.description) && device_->write({})) ++report_.writes;
    device_.reset();
    report_.state = State::absent;
}

void Keeper::lose(const Error& error) {
    ++report_.losses;
    report_.trouble = error.message();
    device_.reset();
    report_.state = State::absent;
    next_try_ = timer_.now() + pause_;
}

Status Keeper::write(const Order& order, double now) {
    if (!renders(*report_.description)) return {};
    const bool is_new = order.number != order_;
    if (is_new) {
        order_ = order.number;
        ordered_ = now;
    }
    const bool stale = now - ordered_ >= options_.stale;
    force::OutputCommand command;
    if (order.enabled && !stale && finite(order.command))
        command = within(*report_.description, order.command);
    const bool forces = command.force != Vec3(0.0) || command.torque != Vec3(0.0);
    // The same force is written again with every order: some devices let go when they hear nothing.
    if (!(forces && is_new) && !(!forces && forced_)) return {};
    if (stale && order.enabled && rendering_) ++report_.lapses;
    if (Status written = device_->write(command); !written) return written;
    ++report_.writes;
    forced_ = rendering_ = forces;
    return {};
}

void Keeper::listen(bool heard, double now) {
    if (heard) {
        ++report_.samples;
        heard_ = now;
        pause_ = options_.first_pause;  // opening alone proves nothing: some are lost at the first word
        report_.state = State::usable;
        report_.trouble.clear();
        return;
    }
    if (!must_speak() || now - heard_ < options_.silence) return;
    report_.state = State::silent;
    const std::string trouble = report_.description->name + " is plugged in and says nothing of sense";
    if (report_.trouble != trouble) report_.trouble = trouble;
    if (now - heard_ < options_.mute) return;
    ++report_.silences;
    close();
    next_try_ = now + pause_;
}

std::optional<Sample> Keeper::turn(FunctionRef<Order()> order) {
    if (!device_) {
        const double now = timer_.now();
        if (now < next_try_) {
            timer_.wait(std::min(next_try_ - now, 5e-3));
            return {};
        }
        if (!try_open(order().number)) return {};
    }
    Result<std::optional<Sample>> read = device_->read(patience_);
    if (!read) {
        lose(read.error());
        return {};
    }
    const double now = timer_.now();
    std::optional<Sample> sample = *read;
    if (sample && !sound(*sample)) {
        ++report_.malformed;
        sample.reset();
    }
    if (Status written = write(order(), now); !written) {
        lose(written.error());
        return sample;
    }
    listen(sample.has_value(), now);
    return sample;
}

}  // namespace bolt::device
