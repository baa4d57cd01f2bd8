// How a hand moves: minimum-jerk reaches and physiological tremor.
#pragma once

#include <cmath>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/servo/engagement.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::motion {

using bolt::minimum_jerk;

// From one pose to another at share s of the way, on an arc that is `bulge` off the straight way at its
// middle.
inline Pose along(const Pose& from, const Pose& to, double s, const Vec3& bulge) {
    return {glm::mix(from.position, to.position, s) + bulge * (4.0 * s * (1.0 - s)),
            glm::slerp(from.orientation, to.orientation, s)};
}

// Two incommensurate sines per axis in the 8–12 Hz band, unit amplitude each axis, phases by seed.
class Tremor {
  public:
    explicit Tremor(Random& random) {
        for (int i = 0; i < count; ++i) {
            rate_[i] = 2.0 * pi * random.uniform(8.0, 12.0);
            phase_[i] = random.uniform(0.0, 2.0 * pi);
        }
    }
    [[nodiscard]] Vec3 at(double time) const { return {pair(time, 0), pair(time, 2), pair(time, 4)}; }
    [[nodiscard]] double torsion(double time) const { return pair(time, 6); }

  private:
    static constexpr int count = 8;
    [[nodiscard]] double pair(double time, int i) const {
        return 0.5 * (std::sin(rate_[i] * time + phase_[i]) + std::sin(rate_[i + 1] * time + phase_[i + 1]));
    }
    double rate_[count];
    double phase_[count];
};

// Path planning for a simulated hand: free room for a handle and collision-free reaches. Queries the
// obstacles of the contact simulation.

// Orientation of a tool whose handle stands at the given angle about the bolt (tightening positive).
Quat orientation_of(const servo::NutGeometry& nut, double handle_angle, bool flipped);

struct Way {
    Vec3 bulge{0.0};             // m, off the straight way (minimum_jerk.hpp)
    std::vector<Pose> stations;  // poses to go to first, straight: where it cannot be reached in one go
};

// A reach from one pose to the other in which the wrench meets nothing that can be seen: off the straight way
// along `up` by `least` or more, else to a side too, else straight up, across and down, else by way of a
// place in the open where the wrench is turned; over the top as high as was tried if there is none.
Way way_round(const servo::Setup& setup, const servo::ToolContact& touch, const Pose& from, const Pose& to,
              const Vec3& up, double least);

struct GripAngle {
    double handle = 0.0;  // rad, about the bolt
    bool flipped = false;
    double room = 0.0;  // rad that the handle may swing from there
};

// Of the angles at which the jaw fits (every 60°, and 30° between with the wrench flipped), the one nearest
// to `wanted` that has room for a pull of `stroke` in the sense of `sign` (tightening positive), and to get
// there. Without obstacles all have.
GripAngle choose_grip(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                      double nut_angle, double wanted, double sign, double stroke);

// m above its nut where a wrench that is to go onto it waits: at most `most`, less where something stands
// over the nut.
double room_above(const servo::Setup& setup, const servo::ToolContact& touch, std::size_t joint,
                  double nut_angle, const GripAngle& grip, double most);

// A hand is not stronger than this: where the wrench stays behind, it does too.
Pose give_way(const Pose& wanted, const Pose& wrench);

}  // namespace bolt::motion
