// A lesson's station whose time stands until a test lets it pass: mouse and keyboard move the tool.
#pragma once

#include <deque>

#include "game/play/course.hpp"
#include "game/station/bench.hpp"
#include "haptics/device/line.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::test {

class VirtualBench final : public station::Bench {
  public:
    VirtualBench(play::Prepared prepared, play::CourseOptions options)
        : puck_({}, device::timer_of(time_)), keeper_(puck_.open(), device::timer_of(time_)) {
        while (!keeper_.report().description) serve();
        layout_.mover = *keeper_.report().description;
        layout_.mover_buttons = {1, 0, 0, 0};
        options.device = station::limits_of(layout_);
        play::use_device(options, prepared);
        setup_ = prepared.setup;
        servo_ = std::move(prepared.state);
        state_ = station::initial_state(layout_);
        wishes_.pause = true;
    }

    // A glove, its wrist there in the frame of the tool.
    void wear(const station::ShownHand& hand, const Pose& wrist) {
        hand_ = hand;
        layout_.wrist = wrist;
        state_ = station::initial_state(layout_);
    }

    // Ticks for so long.

    void pass(double seconds) {
        owed_ += seconds;
        for (; owed_ >= setup_.dt; owed_ -= setup_.dt) tick();
    }

    void wish(const station::Wishes& wishes) override { wishes_ = wishes; }
    void push(const device::Push& push) override { puck_.put(push); }
    bool next(station::Ticked& tick) override {
        if (ticks_.empty()) return false;
        tick = ticks_.front();
        ticks_.pop_front();
        return true;
    }
    const station::Ticked& newest() override { return newest_; }
    [[nodiscard]] std::uint64_t lost() const override { return lost_; }
    const station::ShownHand* hand() override { return hand_ ? &*hand_ : nullptr; }
    std::vector<std::string> troubles() override { return troubles_; }
    [[nodiscard]] const station::Layout& layout() const override { return layout_; }
    [[nodiscard]] const servo::Setup& setup() const override { return setup_; }
    const servo::Timing* stop() override {
        stopped_ = true;
        return nullptr;
    }

    // A device that lies, in ways that a test wants.
    std::vector<std::string> troubles_;
    std::uint64_t lost_ = 0;
    std::optional<station::ShownHand> hand_;  // in a glove
    bool unplugged_ = false;
    bool garbles_ = false;  // what it says of the next tick is not what it did

  private:
    void serve() { device::serve(keeper_, boxes_, told_); }
    void tick() {
        if (stopped_) return;
        now_ += setup_.dt;
        while (time_.now < now_) serve();
        station::Heard heard;
        boxes_.told.update();
        heard.mover = boxes_.told.latest();
        heard.mover.usable = heard.mover.usable && !unplugged_;
        heard.wishes = wishes_;
        if (hand_) heard.hand = hand_->held ? servo::Grip::wrench : servo::Grip::none;

        const bool works = !wishes_.pause;
        const station::Answer answer = works ? station::tick(layout_, setup_, state_, servo_, heard)
                                             : station::pause(layout_, setup_, state_, heard);
        boxes_.orders.write({answer.mover, true, ++orders_});
        newest_ = {++number_,   state_.input,  state_.output, state_.workspace.tool,
                   state_.lies, state_.pressed};
        if (std::exchange(garbles_, false)) newest_.input.device.position[0] += 1e-3F;
        if (works) ticks_.push_back(newest_);
    }

    device::VirtualTime time_;
    device::Puck puck_;
    device::Keeper keeper_;
    device::Mailboxes boxes_;
    device::Told told_;
    station::Layout layout_;
    servo::Setup setup_;
    servo::State servo_;
    station::State state_;
    station::Wishes wishes_;
    std::deque<station::Ticked> ticks_;
    station::Ticked newest_;
    double now_ = 0.0, owed_ = 0.0;  // s
    std::uint64_t number_ = 0, orders_ = 0;
    bool stopped_ = false;
};

}  // namespace bolt::test
