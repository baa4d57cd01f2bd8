#include "tools/verify/oracle/surface.hpp"

#include <algorithm>

namespace bolt::contact_oracle {

Surface make_surface(std::vector<geometry::Triangle> triangles) {
    return {geometry::Bvh(std::move(triangles))};
}

double signed_distance(const Surface& surface, const Vec3& point, double reach) {
    const double distance = nearest(surface.tree, point, reach).distance;
    return winding(surface, point) != 0 ? -distance : distance;
}

double depth(const Surface& a, const Surface& b, const Pose& b_to_a, const DepthOptions& options) {
    if (!cross(a.tree, b.tree, b_to_a)) return 0.0;
    const double first = depth_in(b.tree, a, b_to_a, options);
    DepthOptions rest = options;
    rest.least = std::max(options.least, first);
    return std::max(first, depth_in(a.tree, b, inverse(b_to_a), rest));
}

}  // namespace bolt::contact_oracle
