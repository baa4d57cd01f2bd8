#include "tools/author/import/hexagons.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <cmath>
#include <gp_Pln.hxx>

namespace bolt::step_import {

std::vector<PlaneFace> find_plane_faces(const FaceMap& faces) {
    std::vector<PlaneFace> plane_faces;
    for (int f = 1; f <= faces.Extent(); ++f) {
        const TopoDS_Face face = TopoDS::Face(faces(f));
        const BRepAdaptor_Surface surface(face, false);
        if (surface.GetType() != GeomAbs_Plane) continue;
        const gp_Pln plane = surface.Plane();
        gp_XYZ normal = plane.Axis().Direction().XYZ();
        if (!plane.Direct()) normal.Reverse();
        if (face.Orientation() == TopAbs_REVERSED) normal.Reverse();
        PlaneFace found;
        found.normal = direction_to_scene(normal);
        found.distance = glm::dot(found.normal, point_to_scene(plane.Location().XYZ()));
        found.face = static_cast<std::size_t>(f - 1);
        plane_faces.push_back(found);
    }
    return plane_faces;
}

namespace {

// Two parallel plane faces with opposite normals, as indices in the list of plane faces.
struct FacePair {
    std::size_t a, b;
    double width;
};

std::vector<FacePair> find_pairs(const std::vector<PlaneFace>& plane_faces, HexagonSide side,
                                 const WidthRange& widths) {
    std::vector<FacePair> pairs;
    for (std::size_t a = 0; a < plane_faces.size(); ++a)
        for (std::size_t b = a + 1; b < plane_faces.size(); ++b) {
            const double apart = plane_faces[a].distance + plane_faces[b].distance;
            const double width = side == HexagonSide::outside ? apart : -apart;
            if (glm::dot(plane_faces[a].normal, plane_faces[b].normal) < -1.0 + parallel &&
                width > widths.low && width < widths.high)
                pairs.push_back({a, b, width});
        }
    return pairs;
}

}  // namespace

std::optional<HexagonShape> find_hexagon(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                                         HexagonSide side, const WidthRange& widths) {
    const std::vector<FacePair> pairs = find_pairs(plane_faces, side, widths);
    const auto same_width_at_60 = [&](const FacePair& p, const FacePair& q) {
        return std::abs(std::abs(glm::dot(plane_faces[p.a].normal, plane_faces[q.a].normal)) - 0.5) < 1e-4 &&
               std::abs(p.width - q.width) < plane_position_tolerance;
    };
    for (std::size_t i = 0; i < pairs.size(); ++i)
        for (std::size_t k = i + 1; k < pairs.size(); ++k) {
            const FacePair &p = pairs[i], &q = pairs[k];
            if (!same_width_at_60(p, q)) continue;
            const Vec3 u = plane_faces[p.a].normal, v = plane_faces[q.a].normal;
            const Vec3 axis = glm::normalize(glm::cross(u, v));
            const auto middle = [&](const FacePair& pair) {
                return 0.5 * (plane_faces[pair.a].distance - plane_faces[pair.b].distance);
            };
            const double uv = glm::dot(u, v), mu = middle(p), mv = middle(q);
            const double det = 1.0 - uv * uv;
            const Vec3 centre = u * ((mu - uv * mv) / det) + v * ((mv - uv * mu) / det);
            for (std::size_t l = k + 1; l < pairs.size(); ++l) {
                const FacePair& r = pairs[l];
                if (!same_width_at_60(p, r) || !same_width_at_60(q, r)) continue;
                const Vec3 w = plane_faces[r.a].normal;
                if (std::abs(glm::dot(w, axis)) > 1e-3 ||
                    std::abs(glm::dot(w, centre) - middle(r)) > plane_position_tolerance)
                    continue;
                HexagonShape hexagon{{centre, axis}, p.width, {}};
                for (const std::size_t n : {p.a, p.b, q.a, q.b, r.a, r.b})
                    for (const std::uint32_t point : mesh.faces[plane_faces[n].face].points)
                        hexagon.height.add(hexagon.axis.height(mesh.points[point]));
                return hexagon;
            }
        }
    return std::nullopt;
}

double largest_radius(const PartMesh& mesh, const AxisLine& line) {
    double radius = 0.0;
    for (const Vec3& point : mesh.points) radius = std::max(radius, line.radius(point));
    return radius;
}

double face_radius(const PartMesh& mesh, std::size_t face, const AxisLine& line) {
    double radius = 0.0;
    for (const std::uint32_t point : mesh.faces[face].points)
        radius = std::max(radius, line.radius(mesh.points[point]));
    return radius;
}

}  // namespace bolt::step_import
