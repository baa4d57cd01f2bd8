// Environment light: evaluates the radiance of a direction, and samples directions by their brightness.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/shading/environment.hpp"

namespace bolt::pathtrace {

using assets::read_hdr;
using assets::write_hdr;
using shading::constant;
using shading::RadianceImage;
using shading::studio;

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
    // Directions from which more light comes are proposed more often.
    [[nodiscard]] DirectionSample sample(const glm::vec2& u) const;
    [[nodiscard]] float density(const glm::vec3& direction) const;

  private:
    RadianceImage image_;
    std::vector<double> rows_;     // running sums of the rows' weights
    std::vector<double> columns_;  // and of pixels within each row
    double total_ = 0.0;
};

}  // namespace bolt::pathtrace
