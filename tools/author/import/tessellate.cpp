#include "tools/author/import/tessellate.hpp"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <numeric>

#include "tools/author/import/face_surface.hpp"
#include "tools/author/import/step_document.hpp"

namespace bolt::step_import {

namespace {

// Disjoint-set forest: the corners of all faces, grouped by common point.
class DisjointSets {
  public:
    std::size_t add(std::size_t count) {
        const std::size_t first = parent_.size();
        parent_.resize(first + count);
        std::iota(parent_.begin() + static_cast<std::ptrdiff_t>(first), parent_.end(), first);
        return first;
    }
    [[nodiscard]] std::size_t size() const { return parent_.size(); }
    std::size_t find(std::size_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    // The smaller index represents the union, so that the result does not depend on the order of the calls.
    void unite(std::size_t a, std::size_t b) {
        a = find(a);
        b = find(b);
        if (a != b) parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::size_t> parent_;
};

struct MeshedFace {
    TopoDS_Face face;
    Handle(Poly_Triangulation) triangulation;  // null if the mesher failed
    TopLoc_Location place;
    std::size_t first = 0;  // index of its first corner in DisjointSets
};

constexpr std::size_t unassigned = static_cast<std::size_t>(-1);

// Unites corners along the edges. The mesher creates the same points, in the same order, on every face of an
// edge.
class Stitcher {
  public:
    Stitcher(const TopoDS_Shape& shape, DisjointSets& sets) : sets_(sets) {
        TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
        TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
        on_edge_.resize(static_cast<std::size_t>(edges_.Extent()));
        at_vertex_.assign(static_cast<std::size_t>(vertices_.Extent()), unassigned);
    }

    void add(const MeshedFace& meshed) {
        for (TopExp_Explorer at(meshed.face, TopAbs_EDGE); at.More(); at.Next())
            add_edge(meshed, TopoDS::Edge(at.Current()));
    }

  private:
    DisjointSets& sets_;
    TopTools_IndexedMapOfShape edges_, vertices_;
    std::vector<std::vector<std::size_t>> on_edge_;
    std::vector<std::size_t> at_vertex_;

    void add_edge(const MeshedFace& meshed, const TopoDS_Edge& edge) {
        // A seam edge has one polygon for each side; the orientation of the edge selects it.
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, meshed.triangulation, meshed.place);
        if (polygon.IsNull()) return;
        const TColStd_Array1OfInteger& nodes = polygon->Nodes();
        std::vector<std::size_t> corners;
        for (int i = nodes.Lower(); i <= nodes.Upper(); ++i)
            corners.push_back(meshed.first + static_cast<std::size_t>(nodes(i) - 1));
        const TopoDS_Edge forward = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        join_vertex(TopExp::FirstVertex(forward, true), corners.front());
        join_vertex(TopExp::LastVertex(forward, true), corners.back());
        if (BRep_Tool::Degenerated(edge)) {  // the pole of a sphere: all its corners are one point
            for (const std::size_t corner : corners) sets_.unite(corners.front(), corner);
            return;
        }
        std::vector<std::size_t>& known = on_edge_[static_cast<std::size_t>(edges_.FindIndex(edge) - 1)];
        if (known.empty()) {
            known = corners;
        } else if (known.size() == corners.size()) {
            for (std::size_t i = 0; i < corners.size(); ++i) sets_.unite(known[i], corners[i]);
        }
    }

    void join_vertex(const TopoDS_Vertex& vertex, std::size_t corner) {
        if (vertex.IsNull()) return;
        const int index = vertices_.FindIndex(vertex);
        if (index == 0) return;
        std::size_t& known = at_vertex_[static_cast<std::size_t>(index - 1)];
        if (known == unassigned)
            known = corner;
        else
            sets_.unite(known, corner);
    }
};

// Returns true if the triangles of the face are wound inwards.
bool inside_out(const MeshedFace& meshed) {
    return (meshed.face.Orientation() == TopAbs_REVERSED) != meshed.place.Transformation().IsNegative();
}

// Sets the normals of the surface at the corners. At a pole and at the tip of a cone, where the surface has
// none, takes the normal slightly inside the face.
void add_normals(const FaceSurface& surface, const std::vector<Vec3>& corners, FaceMesh& face) {
    face.normals.assign(corners.size(), Vec3{0.0});
    std::vector<gp_XY> inside(corners.size(), gp_XY(0.0, 0.0));
    std::vector<Vec3> flat(corners.size(), Vec3{0.0});
    for (const auto& [a, b, c] : face.triangles) {
        const Vec3 normal = glm::cross(corners[b] - corners[a], corners[c] - corners[a]);
        const gp_XY middle = (surface.at(a) + surface.at(b) + surface.at(c)) / 3.0;
        for (const std::uint32_t i : {a, b, c}) {
            flat[i] += normal;
            inside[i] = middle;
        }
    }
    for (std::uint32_t i = 0; i < corners.size(); ++i) {
        const gp_XY uv = surface.at(i);
        // Rounding may place a pole outside the parameter range, where the normal points inwards.
        Vec3 normal = surface.is_pole(i) ? Vec3{0.0} : surface.normal(uv);
        constexpr double step = 1e-3;
        if (glm::dot(normal, normal) < 0.5) normal = surface.normal(uv * (1.0 - step) + inside[i] * step);
        if (glm::dot(normal, normal) < 0.5) normal = flat[i];
        const double length = glm::length(normal);
        face.normals[i] = length > 0.0 ? normal / length : Vec3{0.0, 1.0, 0.0};
    }
}

}  // namespace

PartMesh tessellate(const TopoDS_Shape& shape, const Deflection& deflection) {
    BRepTools::Clean(shape, true);
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection.length_mm;
    parameters.Angle = deflection.angle;
    parameters.InParallel = false;  // keeps the result the same on every machine
    const BRepMesh_IncrementalMesh mesher(shape, parameters);

    const FaceMap faces = faces_of(shape);
    PartMesh mesh;
    mesh.faces.resize(static_cast<std::size_t>(faces.Extent()));
    std::vector<MeshedFace> meshed(mesh.faces.size());
    DisjointSets sets;
    Stitcher stitcher(shape, sets);
    for (std::size_t f = 0; f < meshed.size(); ++f) {
        MeshedFace& one = meshed[f];
        one.face = TopoDS::Face(faces(static_cast<int>(f) + 1));
        one.triangulation = BRep_Tool::Triangulation(one.face, one.place);
        if (one.triangulation.IsNull() || !one.triangulation->HasUVNodes()) {
            one.triangulation.Nullify();
            mesh.without_triangles.push_back(f);
            continue;
        }
        one.first = sets.add(static_cast<std::size_t>(one.triangulation->NbNodes()));
        stitcher.add(one);
    }

    // The point of each set of corners.
    std::vector<std::uint32_t> point_of(sets.size(), 0xFFFFFFFFU);
    for (std::size_t f = 0; f < meshed.size(); ++f) {
        const MeshedFace& one = meshed[f];
        if (one.triangulation.IsNull()) continue;
        FaceMesh& face = mesh.faces[f];
        const gp_Trsf place = one.place.Transformation();
        std::vector<Vec3> corners;
        for (int i = 1; i <= one.triangulation->NbNodes(); ++i) {
            // All faces use the point of the first face, so that a tolerance in the file opens no gap.
            std::uint32_t& point = point_of[sets.find(one.first + static_cast<std::size_t>(i - 1))];
            if (point == 0xFFFFFFFFU) {
                point = static_cast<std::uint32_t>(mesh.points.size());
                mesh.points.push_back(point_to_scene(one.triangulation->Node(i).Transformed(place).XYZ()));
            }
            face.points.push_back(point);
            corners.push_back(mesh.points[point]);
        }
        const bool flip = inside_out(one);
        for (int t = 1; t <= one.triangulation->NbTriangles(); ++t) {
            int a = 0, b = 0, c = 0;
            one.triangulation->Triangle(t).Get(a, b, c);
            if (flip) std::swap(b, c);
            const std::array<std::uint32_t, 3> triangle = {static_cast<std::uint32_t>(a - 1),
                                                           static_cast<std::uint32_t>(b - 1),
                                                           static_cast<std::uint32_t>(c - 1)};
            const auto p = [&](std::size_t k) { return face.points[triangle[k]]; };
            if (p(0) != p(1) && p(1) != p(2) && p(2) != p(0)) face.triangles.push_back(triangle);
        }
        FaceSurface surface(one.face, one.triangulation);
        refine(surface, corners, face.triangles, deflection.length_mm * mm);
        for (std::size_t i = face.points.size(); i < corners.size(); ++i) {
            face.points.push_back(static_cast<std::uint32_t>(mesh.points.size()));
            mesh.points.push_back(corners[i]);
        }
        add_normals(surface, corners, face);
        face.tangents = tangents_across_lay(one.face, corners, face.normals);
        mesh.deviation = std::max(mesh.deviation, deviation(surface, corners, face.triangles));
    }
    BRepTools::Clean(shape, true);  // otherwise a large assembly would keep every level in memory
    return mesh;
}

std::size_t count_triangles(const PartMesh& mesh) {
    std::size_t count = 0;
    for (const FaceMesh& face : mesh.faces) count += face.triangles.size();
    return count;
}

}  // namespace bolt::step_import
