// Small solids and random poses for contact tests. tools/verify/oracle computes the exact results.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/collision/mesh.hpp"
#include "tools/verify/oracle/contact_oracle.hpp"

namespace contact_test {

using bolt::Pose;
using bolt::Vec3;
using bolt::collision::ContactMesh;

struct Triangles {
    std::vector<glm::vec3> vertices;
    std::vector<std::uint32_t> indices;
    void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
    [[nodiscard]] ContactMesh mesh() const;
};

Triangles box(const Vec3& low, const Vec3& high);
Triangles ball(double radius, int rings = 24);
// An open-ended wrench of flat faces: a jaw with a rounded back, and a handle along +X.
Triangles wrench();
// A block with two pockets and a rib of 1 mm between them. All edges are sharp; the pockets have concave
// edges.
Triangles casing();

// The meshes of a glTF file in the file's frame, one per node whose name begins with `prefix`.
std::vector<ContactMesh> load_parts(const std::filesystem::path& path, const std::string& prefix = {});

// Uniformly distributed over all rotations.

using bolt::contact_oracle::ClosedSurface;

// The triangles of one or more meshes, for the oracle.
ClosedSurface surface_of(const ContactMesh& mesh);
ClosedSurface surface_of(const std::vector<ContactMesh>& meshes);
// A random point within `far` (m) of a random point on the surface.
Vec3 near_surface(const ClosedSurface& surface, double far, bolt::Random& random);

}  // namespace contact_test
