// A wrench, and a random motion of the hand that moves it.
#pragma once

#include "tests/proxy/scene.hpp"

namespace bolt::test {

inline Pose placed(const Vec3& position, const Vec3& turn = Vec3(0.0)) { return {position, rotation(turn)}; }

// Adds a wrench of boxes: a handle along x and two prongs 20 mm apart. The origin is between the prongs.
inline void add_wrench(Scene& scene) {
    add_box(scene, {placed(Vec3(0.09, 0, 0)), Vec3(0.07, 0.008, 0.004)}, 0.015);
    add_box(scene, {placed(Vec3(0.0, 0.014, 0)), Vec3(0.016, 0.004, 0.005)}, 0.009);
    add_box(scene, {placed(Vec3(0.0, -0.014, 0)), Vec3(0.016, 0.004, 0.005)}, 0.009);
}

// A smooth seeded motion around a centre. Sums of sines bound the speed and never repeat.
class Wandering {
  public:
    Wandering(Random& random, const Vec3& centre, double reach, double turn, double speed)
        : centre_(centre), reach_(reach), turn_(turn) {
        for (auto& wave : waves_)
            wave = {random.uniform(0.3, 1.0) * speed / reach, random.uniform(0.0, 2.0 * pi)};
    }
    [[nodiscard]] Pose operator()(double t) const {
        double x[6];
        for (std::size_t i = 0; i < 6; ++i)
            x[i] = 0.5 * (std::sin(waves_[i].rate * t + waves_[i].phase) +
                          std::sin(1.618 * waves_[i].rate * t + 2.0 * waves_[i].phase));
        return placed(centre_ + reach_ * Vec3(x[0], x[1], x[2]), turn_ * Vec3(x[3], x[4], x[5]));
    }

  private:
    struct Wave {
        double rate = 0.0, phase = 0.0;
    };
    Vec3 centre_;
    double reach_, turn_;
    Wave waves_[6];
};

}  // namespace bolt::test
