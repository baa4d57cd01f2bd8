// How a hand moves: minimum-jerk reaches and physiological tremor.
#pragma once

#include <cmath>

#include "engine/base/minimum_jerk.hpp"
#include "engine/base/pose.hpp"
#include "engine/base/random.hpp"

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

}  // namespace bolt::motion
