// Small models that the path tracer is tried on.
#pragma once

#include "engine/assets/model.hpp"

namespace bolt::pathtrace {

// A node with a mesh of one primitive, in `material`; whatever the primitive names as its material.
assets::Model single(assets::Primitive primitive, const assets::Material& material);

// Radius one about the origin, with smooth normals.
assets::Primitive sphere(int meridians, int parallels);

// A square of side two in the plane z = 0, facing +Z.
assets::Primitive square();

// Without a specular layer: f = base colour / π, exactly.
assets::Material matte(const glm::vec3& color);

}  // namespace bolt::pathtrace
