// A small seeded random number generator, and random rotations. The sequences of bits() and uniform() are the
// same on every platform. normal() depends on the C library's log and cos only, while the algorithm of
// std::normal_distribution depends on the standard library. PCG32: M. E. O'Neill, HMC-CS-2014-0905.
#pragma once

#include <cstdint>

#include "engine/base/math.hpp"

namespace bolt {

class Random {
  public:
    // Equal seeds and streams give equal sequences; each stream has a sequence of its own.
    explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

    std::uint32_t bits();                     // 32 uniform bits
    double uniform();                         // [0, 1)
    double uniform(double low, double high);  // [low, high)
    double normal();                          // mean 0, standard deviation 1, clamped to ±3
    bool chance(double probability) { return uniform() < probability; }

  private:
    std::uint64_t state_;
    std::uint64_t increment_;
};

// Three values of normal(). Each is a statement of its own, because compilers evaluate arguments in different
// orders. z is drawn first, as in all recorded results.
inline Vec3 normal_vector(Random& random) {
    const double z = random.normal();
    const double y = random.normal();
    const double x = random.normal();
    return {x, y, z};
}

// A rotation and a direction, uniformly distributed but for the clamping in normal().
inline Quat random_turn(Random& random) {
    const Vec3 axis = normal_vector(random);
    return glm::normalize(Quat(random.normal(), axis));
}
inline Vec3 random_direction(Random& random) { return random_turn(random) * Vec3(1, 0, 0); }

}  // namespace bolt
