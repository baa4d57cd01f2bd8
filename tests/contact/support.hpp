// Small solids, and slow and sure answers about them in double precision, by other means than the finder's.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/pose.hpp"
#include "engine/base/random.hpp"
#include "haptics/contact/mesh.hpp"

namespace contact_test {

using bolt::Pose;
using bolt::Vec3;
using bolt::contact::ContactMesh;

struct Triangles {
    std::vector<glm::vec3> vertices;
    std::vector<std::uint32_t> indices;
    void triangle(const Vec3& a, const Vec3& b, const Vec3& c);
    void quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
    [[nodiscard]] ContactMesh mesh() const;
};

Triangles box(const Vec3& low, const Vec3& high);
Triangles ball(double radius, int rings = 24);
// An open wrench of flat faces: a jaw with a rounded back, and a handle along +X.
Triangles wrench();
// A block with a pocket and a slot that leaves a rib of 1 mm, all edges sharp: concave everywhere that
// matters.
Triangles casing();

// All meshes of a glTF file, one a node, where the nodes are; of nodes whose name begins with `prefix`.
std::vector<ContactMesh> load_parts(const std::filesystem::path& path, const std::string& prefix = {});

// A turn that is uniform over all turns.
bolt::Quat random_turn(bolt::Random& random);
Vec3 random_direction(bolt::Random& random);

using Soup = std::vector<std::array<Vec3, 3>>;
Soup soup(const ContactMesh& mesh, const Pose& pose = {});

// By looking at every triangle; inside by the winding number (van Oosterom and Strackee 1983), which knows
// nothing of normals.
double brute_signed_distance(const Soup& soup, const Vec3& point);
double brute_distance(const Soup& a, const Soup& b);  // of two surfaces that do not meet
bool brute_crossing(const Soup& a, const Soup& b);    // an edge of one passes through a face of the other
// Whether a point of one surface lies deeper than `depth` in the other, where the surfaces meet; of points at
// most `spacing` apart.
bool deeper_than(double depth, const Soup& a, const Soup& b, double spacing);

}  // namespace contact_test
