// Environment light: evaluates the radiance of a direction, and samples directions in proportion to their
// brightness.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/shading/environment.hpp"

namespace bolt::pathtrace {

using assets::read_hdr;
using assets::write_hdr;
using shading::constant_environment;
using shading::RadianceImage;
using shading::studio_environment;

struct DirectionSample {
    glm::vec3 direction{0.0F};
    float density = 0.0F;  // per solid angle
};

class Environment {
  public:
    Environment() = default;  // dark
    explicit Environment(RadianceImage image);

    [[nodiscard]] bool dark() const { return total_ <= 0.0; }
    [[nodiscard]] glm::vec3 radiance(const glm::vec3& direction) const;
    // Samples a direction by brightness; `u` is uniform in the unit square. The environment must not be dark.
    [[nodiscard]] DirectionSample sample(const glm::vec2& u) const;
    // Returns the probability density of a direction in sample(), per solid angle.
    [[nodiscard]] float density(const glm::vec3& direction) const;

  private:
    RadianceImage image_;
    std::vector<double> rows_;     // running sums of the rows' weights
    std::vector<double> columns_;  // and of pixels within each row
    double total_ = 0.0;
};

}  // namespace bolt::pathtrace
