// The plane faces of a part, and six of them that form a hexagon: the outside of a head or a nut, or the
// walls of a socket. In metres, in the part's frame with the axes of the scene (y up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/math.hpp"
#include "tools/author/import/step_document.hpp"
#include "tools/author/import/tessellate.hpp"

namespace bolt::step_import {

inline constexpr double parallel = 1e-6;  // 1 − cos of 0.08°
// Plane faces count as being at equal heights, or equally far apart, if they differ by less than this, m.
inline constexpr double plane_position_tolerance = 0.02 * mm;

struct PlaneFace {
    Vec3 normal;            // outward
    double distance = 0.0;  // m, of the plane from the origin along the normal
    std::size_t face = 0;   // index in PartMesh::faces
};

std::vector<PlaneFace> find_plane_faces(const FaceMap& faces);

struct Interval {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
    void add(double x) {
        low = std::min(low, x);
        high = std::max(high, x);
    }
};

struct AxisLine {
    Vec3 origin, direction;
    [[nodiscard]] double height(const Vec3& p) const { return glm::dot(p - origin, direction); }
    [[nodiscard]] double radius(const Vec3& p) const {
        return glm::length(glm::cross(p - origin, direction));
    }
};

struct HexagonShape {
    AxisLine axis;
    double across_flats = 0.0;
    Interval height;  // of the six faces along the axis
};

// Accepted widths across flats, m.
struct WidthRange {
    double low, high;
};

// `outside`: the faces of the hexagon point away from its axis; `socket`: they point towards it.
enum class HexagonSide { outside, socket };

// Returns three pairs of parallel faces at 60° and equally far apart around one axis; nullopt if there are
// none.
std::optional<HexagonShape> find_hexagon(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                                         HexagonSide side, const WidthRange& widths);

// Largest distance of the part, or of one of its faces, from the axis, m.
double largest_radius(const PartMesh& mesh, const AxisLine& line);
double face_radius(const PartMesh& mesh, std::size_t face, const AxisLine& line);

}  // namespace bolt::step_import
