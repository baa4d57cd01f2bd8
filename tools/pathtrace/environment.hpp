// Light from all around, as an equirectangular image of radiance: the middle column is −Z, the right half +X,
// the top row +Y.
#pragma once

#include <filesystem>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::pathtrace {

struct RadianceImage {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;  // rows from the top
};

// A Radiance .hdr file.
Result<RadianceImage> read_hdr(const std::filesystem::path& path);
Status write_hdr(const std::filesystem::path& path, const RadianceImage& image);

// The built-in light of a photographer's table: a large soft box above, one to either side, a dim surrounding
// that brightens upwards.
RadianceImage studio(int width = 256);

RadianceImage constant(const glm::vec3& radiance);

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
