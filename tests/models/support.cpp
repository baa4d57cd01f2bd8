#include "support.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>

namespace bolt::models {

namespace {

std::vector<double> sorted_distinct(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < 1e-6; }),
                 values.end());
    return values;
}

}  // namespace

std::vector<double> radii(const TopoDS_Shape& shape, double x, double y) {
    std::vector<double> result;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(faces.Current()));
        if (surface.GetType() != GeomAbs_Cylinder) continue;
        const gp_Cylinder cylinder = surface.Cylinder();
        const gp_Pnt at = cylinder.Location();
        if (std::abs(cylinder.Axis().Direction().Z()) > 1.0 - 1e-9 &&
            std::hypot(at.X() - x, at.Y() - y) < 0.01)
            result.push_back(cylinder.Radius());
    }
    return sorted_distinct(std::move(result));
}

std::vector<double> flat_to_flat(const TopoDS_Shape& shape) {
    std::vector<gp_Pln> sides;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(faces.Current()));
        if (surface.GetType() == GeomAbs_Plane && std::abs(surface.Plane().Axis().Direction().Z()) < 1e-9)
            sides.push_back(surface.Plane());
    }
    std::vector<double> result;
    for (const gp_Pln& a : sides)
        for (const gp_Pln& b : sides)
            if (a.Axis().Direction().IsParallel(b.Axis().Direction(), 1e-9) &&
                a.Distance(b.Location()) > 1e-6)
                result.push_back(a.Distance(b.Location()));
    return sorted_distinct(std::move(result));
}

std::vector<double> crossings(const TopoDS_Shape& shape, const gp_Lin& line) {
    IntCurvesFace_ShapeIntersector intersector;
    intersector.Load(shape, 1e-7);
    intersector.Perform(line, -1e3, 1e3);
    std::vector<double> result;
    for (int i = 1; i <= intersector.NbPnt(); ++i) result.push_back(intersector.WParameter(i));
    return sorted_distinct(std::move(result));
}

std::vector<gp_Pnt> surface_points(const TopoDS_Shape& shape, double deflection, std::size_t every) {
    BRepTools::Clean(shape);
    BRepMesh_IncrementalMesh(shape, deflection, Standard_False, 0.5, Standard_False);
    std::vector<gp_Pnt> points;
    std::size_t count = 0;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        TopLoc_Location location;
        const auto mesh = BRep_Tool::Triangulation(TopoDS::Face(faces.Current()), location);
        for (int i = 1; !mesh.IsNull() && i <= mesh->NbNodes(); ++i)
            if (count++ % every == 0) points.push_back(mesh->Node(i).Transformed(location));
    }
    return points;
}

// The distance to the solid itself would be 0, so it is measured to its shell.
DepthInside::DepthInside(const TopoDS_Shape& solid)
    : classifier_(solid), shell_(TopExp_Explorer(solid, TopAbs_SHELL).Current()) {}

double DepthInside::operator()(const gp_Pnt& point) {
    classifier_.Perform(point, 1e-6);
    if (classifier_.State() != TopAbs_IN) return 0.0;
    return BRepExtrema_DistShapeShape(BRepBuilderAPI_MakeVertex(point), shell_).Value();
}

int triangles(const TopoDS_Shape& shape, double deflection, double angle) {
    BRepTools::Clean(shape);
    BRepMesh_IncrementalMesh(shape, deflection, Standard_False, angle, Standard_False);
    int count = 0;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        TopLoc_Location location;
        const auto mesh = BRep_Tool::Triangulation(TopoDS::Face(faces.Current()), location);
        if (!mesh.IsNull()) count += mesh->NbTriangles();
    }
    return count;
}

Extent extent(const TopoDS_Shape& shape) {
    Bnd_Box box;
    BRepBndLib::AddOptimal(shape, box, Standard_False, Standard_False);
    Extent e{};
    box.Get(e.x0, e.y0, e.z0, e.x1, e.y1, e.z1);
    return e;
}

bool has(const std::vector<double>& values, double expected, double tolerance) {
    return std::any_of(values.begin(), values.end(),
                       [&](double v) { return std::abs(v - expected) < tolerance; });
}

}  // namespace bolt::models
