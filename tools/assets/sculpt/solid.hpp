// A scene built of plain solids: boxes with rounded edges, turned parts, and things sculpted from a field.
// Every node has one mesh with a primitive per material; texture coordinates are metres laid on box faces,
// times the material's scale.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/assets/sculpt/field.hpp"

namespace bolt::sculpt {

class Solid {
  public:
    // Texture repeats per metre, by material.
    explicit Solid(std::span<const double> repeats) : repeats_(repeats) {}

    struct Rounding {
        double radius = 2 * mm;
        int segments = 1;
    };

    void box(int material, const Vec3& centre, const Vec3& size, const Rounding& rounding);
    // Points (radius, height) from the bottom up, turned about the vertical axis through `foot`; sharp
    // corners where `sharp` says so are kept by standing twice in the profile.
    void turned(int material, const Vec3& foot, std::span<const glm::dvec2> profile, int segments,
                const Quat& turn = Quat(1.0, 0.0, 0.0, 0.0));
    void sculpted(int material, const Field& field, const Box& box, double cell, std::size_t triangles,
                  const Vec3& place);

    // Appends node and mesh; the node stands at the origin.
    void add_to(assets::Model& model, const std::string& name);
    [[nodiscard]] std::size_t triangles() const;

  private:
    std::uint32_t vertex(int material, const Vec3& p, const Vec3& n, int face);

    std::span<const double> repeats_;
    std::map<int, assets::Primitive> parts_;
};

}  // namespace bolt::sculpt
