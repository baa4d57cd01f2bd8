// The shape of a gloved right hand as a distance field in the wrist's frame (m): blended round cones around
// the bones, palm, mounds, webs, cuff, and the folds of the glove where it bends.
#pragma once

#include <array>

#include "haptics/hand/kinematics.hpp"
#include "tools/assets/sculpt/field.hpp"

namespace bolt::sculpt {

using namespace hand;  // the joints and their names

// The position of a point relative to a digit.
struct DigitPosition {
    double depth = 0.0;            // distance to the digit's skin, negative inside
    double travel = 0.0;           // m from the first joint (the metacarpal), measured along the bones
    double height = 0.0;           // −1 on the side of the palm, +1 on the back
    Vec3 nearest_axis_point{0.0};  // on the axes of the digit's bones
    std::size_t bone = 0;          // the bone with that point; 0: metacarpal
};

class HandShape {
  public:
    HandShape();

    [[nodiscard]] double operator()(const Vec3& p) const;
    [[nodiscard]] const Skeleton& skeleton() const { return skeleton_; }
    [[nodiscard]] FieldBounds bounds() const;

    // Locates a point relative to digit 0 (thumb) to 4 (little finger).
    [[nodiscard]] DigitPosition locate(std::size_t digit, const Vec3& p) const;
    // Returns the signed distance (m) to the digit alone, from its first knuckle to its tip.
    [[nodiscard]] double digit_distance(std::size_t digit, const Vec3& p) const;
    // Returns the travel (m) of joint k of the digit (0: metacarpal).
    [[nodiscard]] double travel(std::size_t digit, std::size_t k) const { return travel_[digit][k]; }

    static constexpr double cuff_end = 64 * mm;
    static constexpr double hem = 7 * mm;  // height of the hem

  private:
    struct Bone {
        Vec3 a, b;
        Vec3 side, up, forward;
        double length = 0.0, radius_a = 0.0, radius_b = 0.0;
    };

    [[nodiscard]] double palm_body(const Vec3& p) const;
    [[nodiscard]] double folds(const Vec3& p) const;

    Skeleton skeleton_;
    std::array<std::array<Bone, 4>, 5> bones_{};
    std::array<std::size_t, 5> bone_count_{};
    std::array<std::array<double, 5>, 5> travel_{};
};

}  // namespace bolt::sculpt
