#include "tools/assets/models/reducer/shapes.hpp"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Circ.hxx>

namespace bolt::models::reducer {
namespace {

TopTools_ListOfShape list_of(const Shapes& shapes) {
    TopTools_ListOfShape list;
    for (const TopoDS_Shape& shape : shapes) list.Append(shape);
    return list;
}

template <class Operation>
void run(Operation& operation, const char* name) {
    operation.SetRunParallel(false);
    operation.SetNonDestructive(true);
    operation.Build();
    if (!operation.IsDone() || operation.HasErrors())
        throw BuildError{fmt::format("the boolean operation {} failed", name)};
}

// The only child of nested compounds: OpenCASCADE returns a boolean's single solid as a compound.
TopoDS_Shape unwrapped(TopoDS_Shape shape) {
    while (shape.ShapeType() == TopAbs_COMPOUND) {
        TopoDS_Iterator child(shape);
        if (!child.More()) throw BuildError{"a boolean operation has an empty result"};
        const TopoDS_Shape only = child.Value();
        child.Next();
        if (child.More()) return shape;
        shape = only;
    }
    return shape;
}

TopoDS_Shape rounded(std::string_view name, BRepFilletAPI_MakeFillet& fillet, double radius) {
    if (fillet.NbContours() == 0) throw BuildError{fmt::format("{}: no edge was picked for rounding", name)};
    try {
        fillet.Build();
    } catch (const Standard_Failure& failure) {
        throw BuildError{fmt::format("{}: rounding by {} mm: {}", name, radius, failure.GetMessageString())};
    }
    if (!fillet.IsDone()) {
        std::string where;
        for (int i = 1; i <= fillet.NbFaultyContours(); ++i) {
            const gp_Pnt p = middle(fillet.Edge(fillet.FaultyContour(i), 1));
            where += fmt::format(" ({:.1f} {:.1f} {:.1f})", p.X(), p.Y(), p.Z());
        }
        throw BuildError{fmt::format("{}: rounding by {} mm failed at{}", name, radius, where)};
    }
    const TopoDS_Shape result = unwrapped(fillet.Shape());
    if (!BRepCheck_Analyzer(result).IsValid())
        throw BuildError{fmt::format("{}: rounding by {} mm leaves an invalid solid", name, radius)};
    return result;
}

}  // namespace

TopoDS_Shape box(const BoxLimits& b) {
    return BRepPrimAPI_MakeBox(gp_Pnt(b.x0, b.y0, b.z0), gp_Pnt(b.x1, b.y1, b.z1)).Shape();
}

TopoDS_Shape cylinder(const gp_Ax2& axis, double radius, double length) {
    return BRepPrimAPI_MakeCylinder(axis, radius, length).Shape();
}

TopoDS_Shape cylinder_y(double x, double z, double y0, double y1, double radius) {
    return cylinder(gp_Ax2(gp_Pnt(x, y0, z), gp_Dir(0, 1, 0), gp_Dir(0, 0, 1)), radius, y1 - y0);
}

TopoDS_Shape cylinder_z(double x, double y, double z0, double z1, double radius) {
    return cylinder(gp_Ax2(gp_Pnt(x, y, z0), gp_Dir(0, 0, 1)), radius, z1 - z0);
}

TopoDS_Shape revolved(const gp_Ax2& axis, const std::vector<std::pair<double, double>>& outline) {
    std::vector<gp_Pnt> points;
    for (const auto& [radius, along] : outline)
        points.push_back(axis.Location().Translated(gp_Vec(axis.XDirection()) * radius +
                                                    gp_Vec(axis.Direction()) * along));
    const TopoDS_Shape face = BRepBuilderAPI_MakeFace(polygon(points), true).Shape();
    BRepPrimAPI_MakeRevol revol(face, gp_Ax1(axis.Location(), axis.Direction()));
    TopoDS_Shape solid = revol.Shape();
    if (volume(solid) < 0.0) solid.Reverse();
    return solid;
}

TopoDS_Shape extruded(const TopoDS_Wire& outline, const gp_Vec& along) {
    TopoDS_Shape solid = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline, true).Face(), along).Shape();
    if (volume(solid) < 0.0) solid.Reverse();
    return solid;
}

TopoDS_Wire polygon(const std::vector<gp_Pnt>& points) {
    BRepBuilderAPI_MakePolygon maker;
    for (const gp_Pnt& p : points) maker.Add(p);
    maker.Close();
    return maker.Wire();
}

TopoDS_Wire rounded_rectangle(const gp_Ax2& frame, double length, double width, double radius) {
    const gp_Vec u(frame.XDirection()), v(frame.YDirection());
    const auto at = [&](double a, double b) { return frame.Location().Translated(u * a + v * b); };
    const double a = length / 2.0, b = width / 2.0, k = radius * (1.0 - std::sqrt(0.5));
    BRepBuilderAPI_MakeWire wire;
    const int sx[] = {1, -1, -1, 1}, sy[] = {1, 1, -1, -1};
    for (int i = 0; i < 4; ++i) {
        const int n = (i + 1) % 4;
        const double cx = sx[i], cy = sy[i];
        const gp_Pnt on_side = at(cx * a, cy * (b - radius)), on_top = at(cx * (a - radius), cy * b);
        const gp_Pnt from = i % 2 == 0 ? on_side : on_top, to = i % 2 == 0 ? on_top : on_side;
        wire.Add(
            BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(from, at(cx * (a - k), cy * (b - k)), to).Value()));
        const gp_Pnt next =
            n % 2 == 0 ? at(sx[n] * a, sy[n] * (b - radius)) : at(sx[n] * (a - radius), sy[n] * b);
        if (to.Distance(next) > 1e-6) wire.Add(BRepBuilderAPI_MakeEdge(to, next));
    }
    return wire.Wire();
}

TopoDS_Wire hull_y(double y, double x0, double z0, double r0, double x1, double z1, double r1) {
    const double dx = x1 - x0, dz = z1 - z0, d = std::hypot(dx, dz);
    const double along = std::atan2(dz, dx), spread = std::acos((r0 - r1) / d);
    const auto on = [&](double x, double z, double r, double angle) {
        return gp_Pnt(x + r * std::cos(angle), y, z + r * std::sin(angle));
    };
    const double left = along + spread, right = along - spread;
    const gp_Pnt p0 = on(x0, z0, r0, left), p1 = on(x1, z1, r1, left);
    const gp_Pnt q0 = on(x0, z0, r0, right), q1 = on(x1, z1, r1, right);
    BRepBuilderAPI_MakeWire wire;
    wire.Add(BRepBuilderAPI_MakeEdge(p0, p1));
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(p1, on(x1, z1, r1, along), q1).Value()));
    wire.Add(BRepBuilderAPI_MakeEdge(q1, q0));
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(q0, on(x0, z0, -r0, along), p0).Value()));
    return wire.Wire();
}

TopoDS_Shape fused(const Shapes& parts) {
    BRepAlgoAPI_Fuse operation;
    operation.SetArguments(list_of({parts.front()}));
    operation.SetTools(list_of({parts.begin() + 1, parts.end()}));
    run(operation, "fuse");
    const TopoDS_Shape joined = unwrapped(operation.Shape());
    // OpenCASCADE may drop a part without an error.
    const double whole = volume(joined);
    for (const TopoDS_Shape& part : parts)
        if (whole < volume(part) - 1.0) throw BuildError{"a fuse lost one of its parts"};
    return joined;
}

TopoDS_Shape cut(const TopoDS_Shape& body, const Shapes& tools) {
    BRepAlgoAPI_Cut operation;
    operation.SetArguments(list_of({body}));
    operation.SetTools(list_of(tools));
    run(operation, "cut");
    return unwrapped(operation.Shape());
}

TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    BRepAlgoAPI_Common operation;
    operation.SetArguments(list_of({a}));
    operation.SetTools(list_of({b}));
    run(operation, "common");
    return unwrapped(operation.Shape());
}

TopoDS_Shape merged_faces(const TopoDS_Shape& shape) {
    ShapeUpgrade_UnifySameDomain unify(shape, true, true, false);
    unify.Build();
    return unwrapped(unify.Shape());
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by) {
    return BRepBuilderAPI_Transform(shape, by, true).Shape();
}

TopoDS_Shape mirrored_y(const TopoDS_Shape& shape) {
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 1, 0)));
    return moved(shape, mirror);
}

TopoDS_Shape mirrored_z(const TopoDS_Shape& shape) {
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
    return moved(shape, mirror);
}

gp_Pnt middle(const TopoDS_Edge& edge) {
    const BRepAdaptor_Curve curve(edge);
    return curve.Value(0.5 * (curve.FirstParameter() + curve.LastParameter()));
}

bool in_plane_z(const TopoDS_Edge& edge, double z) {
    const BRepAdaptor_Curve curve(edge);
    const double first = curve.FirstParameter(), last = curve.LastParameter();
    for (int i = 0; i <= 4; ++i)
        if (std::abs(curve.Value(first + (last - first) * i / 4.0).Z() - z) > 1e-4) return false;
    return true;
}

TopoDS_Shape filleted(std::string_view name, const TopoDS_Shape& shape, double radius,
                      const EdgePredicate& pick) {
    BRepFilletAPI_MakeFillet fillet(shape);
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
        const TopoDS_Edge edge = TopoDS::Edge(edges(i));
        if (!BRep_Tool::Degenerated(edge) && fillet.Contour(edge) == 0 && pick(edge))
            fillet.Add(radius, edge);
    }
    return rounded(name, fillet, radius);
}

TopoDS_Shape chamfered(std::string_view name, const TopoDS_Shape& shape, double width,
                       const EdgePredicate& pick) {
    BRepFilletAPI_MakeChamfer chamfer(shape);
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) {
        const TopoDS_Edge edge = TopoDS::Edge(edges(i));
        if (!BRep_Tool::Degenerated(edge) && chamfer.Contour(edge) == 0 && pick(edge))
            chamfer.Add(width, edge);
    }
    if (chamfer.NbContours() == 0)
        throw BuildError{fmt::format("{}: no edge was picked for chamfering", name)};
    chamfer.Build();
    if (!chamfer.IsDone() || !BRepCheck_Analyzer(chamfer.Shape()).IsValid())
        throw BuildError{fmt::format("{}: a chamfer of {} mm failed", name, width)};
    return unwrapped(chamfer.Shape());
}

TopoDS_Shape blended(std::string_view name, const TopoDS_Shape& body, const TopoDS_Shape& addition,
                     double radius, const EdgePredicate& skip) {
    BRepAlgoAPI_Fuse operation;
    operation.SetArguments(list_of({body}));
    operation.SetTools(list_of({addition}));
    run(operation, "fuse");
    const TopoDS_Shape joined = unwrapped(operation.Shape());
    if (volume(joined) < volume(body) + 1.0)
        throw BuildError{fmt::format("{}: the addition adds no volume", name)};
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(joined, TopAbs_EDGE, edges);
    BRepFilletAPI_MakeFillet fillet(joined);
    for (const TopoDS_Shape& shape : operation.SectionEdges()) {
        const TopoDS_Edge edge = TopoDS::Edge(shape);
        if (!edges.Contains(edge) || BRep_Tool::Degenerated(edge) || (skip && skip(edge))) continue;
        if (fillet.Contour(edge) == 0) fillet.Add(radius, edge);
    }
    return rounded(name, fillet, radius);
}

double volume(const TopoDS_Shape& shape) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shape, properties);
    return properties.Mass();
}

TopoDS_Shape one_solid(std::string_view name, const TopoDS_Shape& shape) {
    TopExp_Explorer solids(shape, TopAbs_SOLID);
    if (!solids.More()) throw BuildError{fmt::format("{}: contains no solid", name)};
    const TopoDS_Shape solid = solids.Current();
    solids.Next();
    if (solids.More()) throw BuildError{fmt::format("{}: contains more than one solid", name)};
    if (!BRepCheck_Analyzer(solid).IsValid()) throw BuildError{fmt::format("{}: is not a valid solid", name)};
    if (volume(solid) <= 0.0) throw BuildError{fmt::format("{}: is inside out", name)};
    return solid;
}

Error build_error(std::string_view part, const std::string& what) {
    Error error;
    error.what = fmt::format("{}: cannot be built: {}", part, what);
    error.expected = "dimensions that OpenCASCADE can build";
    return error;
}

std::string current_failure() {
    try {
        throw;
    } catch (const BuildError& error) {
        return error.what;
    } catch (const Standard_Failure& failure) {
        return fmt::format("{}: {}", failure.DynamicType()->Name(), failure.GetMessageString());
    }
}

}  // namespace bolt::models::reducer
