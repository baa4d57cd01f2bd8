#include "tools/truth/surface.hpp"

namespace bolt::truth {

Surface make_surface(const contact::ContactMesh& mesh) {
    std::vector<geometry::Triangle> triangles;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = contact::corners(mesh, t);
        triangles.push_back({a, b, c, static_cast<std::uint32_t>(t)});
    }
    return {geometry::Bvh(std::move(triangles))};
}

geometry::Bvh points_of(const contact::Samples& samples) {
    std::vector<geometry::Triangle> points;
    for (const contact::Sample& sample : samples.samples)
        if (sample.piece == contact::Sample::no_piece) points.push_back({sample.at, sample.at, sample.at, 0});
    return geometry::Bvh(std::move(points));
}

}  // namespace bolt::truth
