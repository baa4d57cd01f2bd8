// Small models for the tests of the path tracer.
#pragma once

#include "engine/assets/model.hpp"

namespace bolt::pathtrace {

// A node with a mesh of one primitive, drawn with `material` regardless of primitive.material.
assets::Model single(assets::Primitive primitive, const assets::Material& material);

// A sphere of radius 1 about the origin with smooth normals.
assets::Primitive sphere(int meridians, int parallels);

// A square of side two in the plane z = 0, facing +Z.
assets::Primitive square();

// A material without a specular layer: f = base colour / π, exactly.
assets::Material matte(const glm::vec3& color);

}  // namespace bolt::pathtrace
