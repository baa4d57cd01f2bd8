// What a hand feels, late: the torque and whether the resistance still grows, a reaction time after they were
// so.
#pragma once

#include <algorithm>
#include <vector>

#include "haptics/joint/group.hpp"

namespace bolt::operators {

struct Feeling {
    double torque = 0.0;       // N·m, tightening positive
    double torque_rate = 0.0;  // N·m/s, smoothed over 30 ms
    bool yields = false;       // the resistance no longer grows as it did
    bool seated = false;       // it grows at all: the nut sits
};

class Nerves {
  public:
    Nerves(double reaction, double dt) : dt_(dt), line_(static_cast<std::size_t>(reaction / dt) + 1) {}

    // One tick: what is so now goes in, what was so a reaction time ago comes out.
    const Feeling& feel(const joint::JointState& nut) {
        const Moment late = line_[at_];
        line_[at_] = {nut.torque, nut.stage == joint::Stage::yield, nut.stage != joint::Stage::navigation};
        at_ = (at_ + 1) % line_.size();
        const double rate = (late.torque - now_.torque) / dt_;
        now_.torque_rate += (rate - now_.torque_rate) * std::min(1.0, dt_ / 0.03);
        now_.torque = late.torque;
        now_.yields = late.yields;
        now_.seated = late.seated;
        return now_;
    }

  private:
    struct Moment {
        double torque = 0.0;
        bool yields = false;
        bool seated = false;
    };
    double dt_;
    std::vector<Moment> line_;
    std::size_t at_ = 0;
    Feeling now_;
};

}  // namespace bolt::operators
