#include "tools/author/import/fasteners.hpp"

#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <limits>
#include <optional>

#include "tools/author/geometry/drawn_thread.hpp"
#include "tools/author/import/hexagons.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

namespace {

constexpr std::size_t max_plane_faces = 400;  // more than any fastener has; skips castings
// Largest radius of a fastener / width across its flats.
constexpr double max_radius_ratio = 1.3;
// Largest radius of a screw with a socket / width across the flats of the socket; 1.87 with a countersunk
// head.
constexpr double max_cap_radius_ratio = 1.9;
constexpr double least_stud_length = 1.5;  // in diameters

// Accepted widths across flats, m.
constexpr WidthRange fastener_widths{5.0 * mm, 65.0 * mm};
constexpr WidthRange socket_widths{1.9 * mm, 33.0 * mm};
constexpr WidthRange all_widths{0.05 * mm, 5000.0 * mm};  // a width out of range indicates a wrong unit

// Point-in-mesh test by the solid angle of all triangles (van Oosterom and Strackee 1983).
bool inside(const PartMesh& mesh, const Vec3& p) {
    double sum = 0.0;
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles) {
            const Vec3 a = mesh.points[face.points[triangle[0]]] - p;
            const Vec3 b = mesh.points[face.points[triangle[1]]] - p;
            const Vec3 c = mesh.points[face.points[triangle[2]]] - p;
            const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
            sum += std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
        }
    return std::abs(2.0 * sum) > 2.0 * pi;
}

FastenerShape classify_nut(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                           const HexagonShape& hexagon, const Interval& whole) {
    FastenerShape nut;
    nut.kind = FastenerKind::nut;
    nut.origin = hexagon.axis.origin;
    nut.axis = hexagon.axis.direction;
    nut.across_flats = hexagon.across_flats;
    nut.low = whole.low;
    nut.high = whole.high;
    // Bearing faces; the collar of a locking nut protrudes beyond one of them.
    Interval faces;
    for (const PlaneFace& plane : plane_faces) {
        const double along = glm::dot(plane.normal, nut.axis);
        if (std::abs(along) < 1.0 - parallel) continue;
        if (face_radius(mesh, plane.face, hexagon.axis) < 0.4 * nut.across_flats) continue;
        faces.add(hexagon.axis.height(plane.normal * plane.distance));
    }
    if (faces.high - faces.low > 0.1 * nut.across_flats) {
        nut.low = faces.low;
        nut.high = faces.high;
    }
    double smallest = std::numeric_limits<double>::infinity();
    for (const Vec3& point : mesh.points) smallest = std::min(smallest, hexagon.axis.radius(point));
    nut.diameter = 2.0 * smallest;
    const double height = whole.high - whole.low;
    if (height > 1.2 * nut.across_flats || nut.diameter < 0.4 * nut.across_flats) {
        nut.kind = FastenerKind::none;
        nut.rejection = fmt::format(
            "looks like a nut (hexagon {:.2f} mm across flats), but it is {:.2f} mm high and its hole is "
            "{:.2f} mm wide; expected at most {:.2f} mm high and a hole of at least {:.2f} mm",
            nut.across_flats / mm, height / mm, nut.diameter / mm, 1.2 * nut.across_flats / mm,
            0.4 * nut.across_flats / mm);
    }
    return nut;
}

// Diameter of a bolt over the crests of its thread, m, beyond the fillet under its head.
double crest_diameter(const PartMesh& mesh, const FastenerShape& bolt) {
    const AxisLine line{bolt.origin, bolt.axis};
    double crest = 0.0;
    for (const Vec3& point : mesh.points)
        if (line.height(point) > bolt.low + 0.15 * (bolt.high - bolt.low))
            crest = std::max(crest, line.radius(point));
    return 2.0 * crest;
}

// A bolt or a screw from its hexagon, with the axis towards its end: away from the hexagon. Turns the
// intervals along the axis accordingly.
FastenerShape shape_from_hexagon(const HexagonShape& hexagon, Interval& height, Interval& whole) {
    FastenerShape shape;
    shape.origin = hexagon.axis.origin;
    shape.axis = hexagon.axis.direction;
    shape.across_flats = hexagon.across_flats;
    height = hexagon.height;
    if (height.low - whole.low <= whole.high - height.high) return shape;
    shape.axis = -shape.axis;
    height = {-hexagon.height.high, -hexagon.height.low};
    whole = {-whole.high, -whole.low};
    return shape;
}

FastenerShape classify_bolt(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                            const HexagonShape& hexagon, Interval whole) {
    Interval head;
    FastenerShape bolt = shape_from_hexagon(hexagon, head, whole);
    const AxisLine line{bolt.origin, bolt.axis};
    bolt.high = whole.high;
    bolt.low = head.high;
    // Bearing face: at the end of the flats, or on a washer face beyond them, wider than any shank.
    double best = -std::numeric_limits<double>::infinity();
    for (const PlaneFace& plane : plane_faces) {
        if (glm::dot(plane.normal, bolt.axis) < 1.0 - parallel) continue;
        const double height = line.height(plane.normal * plane.distance);
        if (height < head.high - plane_position_tolerance || height > head.high + 0.2 * bolt.across_flats)
            continue;
        if (face_radius(mesh, plane.face, line) < 0.4 * bolt.across_flats) continue;
        best = std::max(best, height);
    }
    if (std::isfinite(best)) bolt.low = best;
    const double length = bolt.high - bolt.low;
    bolt.diameter = crest_diameter(mesh, bolt);
    const bool shank = bolt.diameter > 0.4 * bolt.across_flats && bolt.diameter < 0.85 * bolt.across_flats;
    if (shank && length > 0.5 * bolt.diameter)
        bolt.kind = FastenerKind::bolt;
    else
        bolt.rejection = fmt::format(
            "looks like a bolt (hexagon {:.2f} mm across flats), but its shank is {:.2f} mm wide and "
            "{:.2f} mm long under the head; expected a shank {:.2f} to {:.2f} mm wide and longer than half "
            "its width",
            bolt.across_flats / mm, bolt.diameter / mm, std::max(length, 0.0) / mm,
            0.4 * bolt.across_flats / mm, 0.85 * bolt.across_flats / mm);
    return bolt;
}

// The bearing face of a cap screw's head, as a height along the screw's axis: the plane that faces the
// end of the screw and is nearly as wide as the head; nullopt without one.
std::optional<double> cap_bearing_face(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                                       const AxisLine& line, double head_radius) {
    std::optional<double> bearing;
    for (const PlaneFace& plane : plane_faces) {
        if (glm::dot(plane.normal, line.direction) < 1.0 - parallel) continue;
        if (face_radius(mesh, plane.face, line) < 0.8 * head_radius) continue;
        const double height = line.height(plane.normal * plane.distance);
        if (!bearing || height > *bearing) bearing = height;
    }
    return bearing;
}

// Classifies a part with a hexagonal socket.
FastenerShape classify_cap_screw(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                                 const HexagonShape& hexagon, Interval whole) {
    Interval socket;
    FastenerShape screw = shape_from_hexagon(hexagon, socket, whole);
    const AxisLine line{screw.origin, screw.axis};
    const double head_radius = largest_radius(mesh, line);
    const auto bearing = cap_bearing_face(plane_faces, mesh, line, head_radius);
    const std::string found = fmt::format("has a hexagonal socket of {:.2f} mm", screw.across_flats / mm);
    if (!bearing || *bearing - whole.low < 0.2 * screw.across_flats ||
        *bearing > whole.high - plane_position_tolerance) {
        screw.rejection = found +
                          ", but no flat bearing face under a head; expected a cylindrical head with a "
                          "flat face towards the shank";
        return screw;
    }
    screw.low = *bearing;
    screw.high = whole.high;
    screw.diameter = crest_diameter(mesh, screw);
    screw.cap = CapHead{2.0 * head_radius, screw.low - whole.low, socket.high - whole.low};
    const double length = screw.high - screw.low;
    const bool shank = screw.diameter > screw.across_flats && screw.diameter < 1.7 * head_radius;
    if (shank && length > 0.5 * screw.diameter)
        screw.kind = FastenerKind::bolt;
    else
        screw.rejection = fmt::format(
            "{}, but its shank is {:.2f} mm wide and {:.2f} mm long under the head; expected a shank {:.2f} "
            "to {:.2f} mm wide and longer than half its width",
            found, screw.diameter / mm, std::max(length, 0.0) / mm, screw.across_flats / mm,
            1.7 * head_radius / mm);
    return screw;
}

// Returns a washer if the part is a flat ring between two radii and two parallel faces.
FastenerShape classify_washer(const TopoDS_Shape& shape, const std::vector<PlaneFace>& plane_faces,
                              const PartMesh& mesh) {
    FastenerShape washer;
    const std::vector<Hole> holes = find_holes(shape);
    if (holes.empty() || plane_faces.size() < 2) return washer;
    const AxisLine line{holes.front().point, holes.front().axis};
    Interval heights, radii, faces;
    for (const Vec3& point : mesh.points) {
        heights.add(line.height(point));
        radii.add(line.radius(point));
    }
    for (const PlaneFace& plane : plane_faces) {
        if (std::abs(glm::dot(plane.normal, line.direction)) < 1.0 - parallel) return washer;
        faces.add(line.height(plane.normal * plane.distance));
    }
    const double thickness = heights.high - heights.low;
    const bool between_planes = faces.low < heights.low + plane_position_tolerance &&
                                faces.high > heights.high - plane_position_tolerance;
    const bool ring = radii.low > 0.25 * radii.high && radii.low < 0.85 * radii.high;
    if (!between_planes || !ring || thickness > 0.35 * radii.high || thickness < 0.1 * mm) return washer;
    washer.kind = FastenerKind::washer;
    washer.origin = line.origin;
    washer.axis = line.direction;
    washer.low = heights.low;
    washer.high = heights.high;
    washer.diameter = 2.0 * radii.low;
    return washer;
}

// The axis of the first outside cylinder or cone; nullopt without one.
std::optional<AxisLine> axis_of_rod(const TopoDS_Shape& shape) {
    const FaceMap faces = faces_of(shape);
    for (int f = 1; f <= faces.Extent(); ++f) {
        const BRepAdaptor_Surface surface(TopoDS::Face(faces(f)), false);
        gp_Ax1 axis;
        if (surface.GetType() == GeomAbs_Cylinder)
            axis = surface.Cylinder().Axis();
        else if (surface.GetType() == GeomAbs_Cone)
            axis = surface.Cone().Axis();
        else
            continue;
        return AxisLine{point_to_scene(axis.Location().XYZ()), direction_to_scene(axis.Direction().XYZ())};
    }
    return {};
}

// Returns a stud if the part is a solid rod that has the diameter of a metric thread at both ends and is
// nowhere thicker. Its shank may be thinner.
FastenerShape classify_stud(const TopoDS_Shape& shape, const std::vector<PlaneFace>& plane_faces,
                            const PartMesh& mesh) {
    FastenerShape stud;
    const std::optional<AxisLine> line = axis_of_rod(shape);
    if (!line || !find_holes(shape).empty()) return stud;
    for (const PlaneFace& plane : plane_faces)
        if (std::abs(glm::dot(plane.normal, line->direction)) < 1.0 - parallel) return stud;
    Interval heights;
    for (const Vec3& point : mesh.points) heights.add(line->height(point));
    const double length = heights.high - heights.low, diameter = 2.0 * largest_radius(mesh, *line);
    if (length < least_stud_length * diameter || size_of_thread(diameter) == nullptr) return stud;
    double low_end = 0.0, high_end = 0.0;  // diameters
    for (const Vec3& point : mesh.points) {
        double& end = line->height(point) < heights.low + 0.5 * length ? low_end : high_end;
        if (std::min(line->height(point) - heights.low, heights.high - line->height(point)) < diameter)
            end = std::max(end, 2.0 * line->radius(point));
    }
    if (std::min(low_end, high_end) < 0.98 * diameter) return stud;
    if (!inside(mesh, line->origin + 0.5 * (heights.low + heights.high) * line->direction)) return stud;
    stud.kind = FastenerKind::stud;
    stud.origin = line->origin;
    stud.axis = line->direction;
    stud.low = heights.low;
    stud.high = heights.high;
    stud.diameter = diameter;
    return stud;
}

int count_solids(const TopoDS_Shape& shape) {
    int solids = 0;
    for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next()) ++solids;
    return solids;
}

void explain_missing_hexagon(const std::vector<PlaneFace>& plane_faces, const PartMesh& mesh,
                             FastenerShape& rejected) {
    const auto hexagon = find_hexagon(plane_faces, mesh, HexagonSide::outside, all_widths);
    if (hexagon && largest_radius(mesh, hexagon->axis) <= max_radius_ratio * hexagon->across_flats)
        rejected.rejection = fmt::format(
            "has a hexagon {:.3f} mm across flats; expected {:g} to {:g} mm: is the unit of the file right?",
            hexagon->across_flats / mm, fastener_widths.low / mm, fastener_widths.high / mm);
    else
        rejected.without_hexagon = fmt::format(
            "none of its {} plane faces form a hexagon; expected three pairs of opposite faces at 60 "
            "degrees, {:g} to {:g} mm apart and equal within {:g} mm",
            plane_faces.size(), fastener_widths.low / mm, fastener_widths.high / mm,
            plane_position_tolerance / mm);
}

}  // namespace

namespace {

FastenerShape recognise_shape(const TopoDS_Shape& shape, const PartMesh& mesh) {
    const FaceMap faces = faces_of(shape);
    const std::vector<PlaneFace> plane_faces = find_plane_faces(faces);
    if (plane_faces.size() > max_plane_faces || mesh.points.empty()) return {};
    const auto whole_along = [&](const AxisLine& line) {
        Interval heights;
        for (const Vec3& point : mesh.points) heights.add(line.height(point));
        return heights;
    };
    const auto socket = find_hexagon(plane_faces, mesh, HexagonSide::socket, socket_widths);
    if (socket && largest_radius(mesh, socket->axis) <= max_cap_radius_ratio * socket->across_flats)
        return classify_cap_screw(plane_faces, mesh, *socket, whole_along(socket->axis));
    const auto hexagon = find_hexagon(plane_faces, mesh, HexagonSide::outside, fastener_widths);
    if (!hexagon) {
        FastenerShape washer = classify_washer(shape, plane_faces, mesh);
        if (washer.kind != FastenerKind::none) return washer;
        FastenerShape stud = classify_stud(shape, plane_faces, mesh);
        if (stud.kind == FastenerKind::none) explain_missing_hexagon(plane_faces, mesh, stud);
        return stud;
    }
    const Interval whole = whole_along(hexagon->axis);
    const double widest = largest_radius(mesh, hexagon->axis);
    if (widest > max_radius_ratio * hexagon->across_flats) {
        FastenerShape other;
        const int solids = count_solids(shape);
        if (solids > 1 || widest < 3.0 * hexagon->across_flats)
            other.rejection = fmt::format(
                "has a hexagon {:.2f} mm across flats, but consists of {} and reaches {:.2f} mm from the "
                "hexagon's axis; expected every bolt and nut to be a part of its own, at most {:.2f} mm "
                "from its axis",
                hexagon->across_flats / mm, solids == 1 ? "1 solid" : fmt::format("{} solids", solids),
                widest / mm, max_radius_ratio * hexagon->across_flats / mm);
        return other;
    }
    const double middle = 0.5 * (hexagon->height.low + hexagon->height.high);
    return inside(mesh, hexagon->axis.origin + middle * hexagon->axis.direction)
               ? classify_bolt(plane_faces, mesh, *hexagon, whole)
               : classify_nut(plane_faces, mesh, *hexagon, whole);
}

// The triangles in a frame whose +Y is the axis.
std::vector<geometry::Triangle> about_axis(const PartMesh& mesh, const Vec3& origin, const Vec3& axis) {
    const Vec3 x =
        glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.7 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
    const Vec3 z = glm::cross(x, axis);
    std::vector<geometry::Triangle> triangles;
    for (const FaceMesh& face : mesh.faces)
        for (const auto& corners : face.triangles) {
            const auto at = [&](std::size_t i) {
                const Vec3 p = mesh.points[face.points[corners[i]]] - origin;
                return Vec3(glm::dot(p, x), glm::dot(p, axis), glm::dot(p, z));
            };
            triangles.push_back({at(0), at(1), at(2)});
        }
    return triangles;
}

}  // namespace

FastenerShape recognise_fastener(const TopoDS_Shape& shape, const PartMesh& mesh) {
    FastenerShape found = recognise_shape(shape, mesh);
    if (found.kind != FastenerKind::bolt && found.kind != FastenerKind::stud) return found;
    if (const auto thread =
            geometry::measure_drawn_thread(about_axis(mesh, found.origin, found.axis), found.diameter))
        found.drawn_thread = thread->direction;
    return found;
}

std::vector<Hole> find_holes(const TopoDS_Shape& shape) {
    std::vector<Hole> holes;
    const FaceMap faces = faces_of(shape);
    for (int f = 1; f <= faces.Extent(); ++f) {
        const TopoDS_Face face = TopoDS::Face(faces(f));
        const BRepAdaptor_Surface surface(face, false);
        if (surface.GetType() != GeomAbs_Cylinder) continue;
        const gp_Cylinder cylinder = surface.Cylinder();
        // The outward normal of a hole points towards its axis.
        if ((face.Orientation() == TopAbs_REVERSED) != cylinder.Direct()) continue;
        holes.push_back({point_to_scene(cylinder.Location().XYZ()),
                         direction_to_scene(cylinder.Axis().Direction().XYZ()), cylinder.Radius() * mm});
    }
    return holes;
}

std::vector<double> crossings(const PartMesh& mesh, const Vec3& origin, const Vec3& direction) {
    std::vector<double> all;
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles) {
            const Vec3 a = mesh.points[face.points[triangle[0]]];
            const Vec3 ab = mesh.points[face.points[triangle[1]]] - a;
            const Vec3 ac = mesh.points[face.points[triangle[2]]] - a;
            const Vec3 p = glm::cross(direction, ac);
            const double det = glm::dot(ab, p);
            if (std::abs(det) < 1e-18) continue;
            const Vec3 from = origin - a;
            const double u = glm::dot(from, p) / det;
            if (u < 0.0 || u > 1.0) continue;
            const Vec3 q = glm::cross(from, ab);
            const double v = glm::dot(direction, q) / det;
            if (v < 0.0 || u + v > 1.0) continue;
            all.push_back(glm::dot(ac, q) / det);
        }
    std::sort(all.begin(), all.end());
    // A line through a shared edge hits both of its triangles.
    all.erase(std::unique(all.begin(), all.end(), [](double x, double y) { return y - x < 1e-9; }),
              all.end());
    return all;
}

}  // namespace bolt::step_import
