// Builds the meshes of a glTF scene from solids: boxes with rounded edges, turned parts, and surfaces of
// distance fields. Each node has one mesh with one primitive per material. Texture coordinates are
// box-projected positions in metres, times the material's repeats.
#pragma once

#include <glm/vec2.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/assets/sculpt/field.hpp"

namespace bolt::sculpt {

class SolidBuilder {
  public:
    // `repeats`: texture repeats per metre, by material.
    explicit SolidBuilder(std::span<const double> repeats) : repeats_(repeats) {}

    struct Rounding {
        double radius = 2 * mm;
        int segments = 1;
    };

    void add_box(int material, const Vec3& centre, const Vec3& size, const Rounding& rounding);
    // Revolves the profile, points (radius, height) from the bottom up, about the vertical axis through
    // `foot`. `turn` rotates the result about `foot`. Every corner of the profile is sharp.
    void add_turned(int material, const Vec3& foot, std::span<const glm::dvec2> profile, int segments,
                    const Quat& turn = Quat(1.0, 0.0, 0.0, 0.0));
    // Adds the surface of `field` within `box`, extracted with cells of size `cell` (m), simplified to about
    // `triangles` triangles and moved by `position`.
    void add_field(int material, const SignedDistanceField& field, const FieldBounds& box, double cell,
                   std::size_t triangles, const Vec3& position);

    // Appends the solids so far to the model as one mesh, with a node at the origin, and clears them.
    void add_to(assets::Model& model, const std::string& name);

  private:
    std::uint32_t vertex(int material, const Vec3& p, const Vec3& n, int face);

    std::span<const double> repeats_;
    std::map<int, assets::Primitive> parts_;
};

}  // namespace bolt::sculpt
