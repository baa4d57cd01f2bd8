#include "tools/assets/models/solids.hpp"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Circle.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>

namespace bolt::models {

namespace {

gp_Pnt in_half_plane(const gp_Pnt2d& p) { return {p.X(), 0.0, p.Y()}; }

}  // namespace

ProfileOutline& ProfileOutline::line(gp_Pnt2d to) {
    wire_.Add(BRepBuilderAPI_MakeEdge(in_half_plane(end_), in_half_plane(to)).Edge());
    end_ = to;
    return *this;
}

ProfileOutline& ProfileOutline::arc(gp_Pnt2d through, gp_Pnt2d to) {
    // The circle's axis is always +Y: revolved about Z, such an arc becomes a torus and not a general surface
    // of revolution.
    const GC_MakeArcOfCircle arc(in_half_plane(end_), in_half_plane(through), in_half_plane(to));
    const auto circle = Handle(Geom_Circle)::DownCast(arc.Value()->BasisCurve());
    const gp_Circ round(gp_Ax2(circle->Location(), gp::DY(), gp::DX()), circle->Radius());
    const bool same_way = circle->Axis().Direction().Y() > 0.0;
    const gp_Pnt from = in_half_plane(same_way ? end_ : to), until = in_half_plane(same_way ? to : end_);
    wire_.Add(BRepBuilderAPI_MakeEdge(round, from, until).Edge());
    end_ = to;
    return *this;
}

TopoDS_Shape ProfileOutline::face() const {
    if (end_.Distance(start_) > 1e-9)
        wire_.Add(BRepBuilderAPI_MakeEdge(in_half_plane(end_), in_half_plane(start_)).Edge());
    return BRepBuilderAPI_MakeFace(wire_.Wire(), Standard_True).Face();
}

TopoDS_Shape revolved(const ProfileOutline& profile) {
    return BRepPrimAPI_MakeRevol(profile.face(), gp::OZ());
}

TopoDS_Shape revolved(std::initializer_list<gp_Pnt2d> corners) {
    ProfileOutline profile(*corners.begin());
    for (const gp_Pnt2d* corner = corners.begin() + 1; corner != corners.end(); ++corner)
        profile.line(*corner);
    return revolved(profile);
}

TopoDS_Shape box(gp_Pnt low, gp_Pnt high) { return BRepPrimAPI_MakeBox(low, high).Shape(); }

TopoDS_Shape rounded_block(double x, double y, double length, double width, double corner, double z0,
                           double z1) {
    const TopoDS_Shape block =
        box(gp_Pnt(x - 0.5 * length, y - 0.5 * width, z0), gp_Pnt(x + 0.5 * length, y + 0.5 * width, z1));
    return rounded(block, corner,
                   [](const gp_Pnt&, const gp_Dir& along) { return std::abs(along.Z()) > 0.99; });
}

TopoDS_Shape cylinder(const gp_Ax2& axis, double radius, double height) {
    return BRepPrimAPI_MakeCylinder(axis, radius, height).Shape();
}

TopoDS_Shape moved(const TopoDS_Shape& shape, const gp_Trsf& by) {
    return BRepBuilderAPI_Transform(shape, by, Standard_True).Shape();
}

gp_Trsf shift(double x, double y, double z) {
    gp_Trsf trsf;
    trsf.SetTranslation(gp_Vec(x, y, z));
    return trsf;
}

gp_Trsf turn(const gp_Ax1& about, double angle) {
    gp_Trsf trsf;
    trsf.SetRotation(about, angle);
    return trsf;
}

namespace {

template <class Operation>
TopoDS_Shape operate(const TopoDS_Shape& a, const std::vector<TopoDS_Shape>& others) {
    Operation operation;
    TopTools_ListOfShape arguments, tools;
    arguments.Append(a);
    for (const TopoDS_Shape& other : others) tools.Append(other);
    operation.SetArguments(arguments);
    operation.SetTools(tools);
    operation.Build();
    operation.SimplifyResult(Standard_True, Standard_True);
    return operation.Shape();
}

template <class Operation, class Add>
TopoDS_Shape with_edges(const TopoDS_Shape& shape, const EdgeSelector& select, const Add& add) {
    Operation operation(shape);
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    bool any = false;
    for (int i = 1; i <= edges.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges(i));
        if (BRep_Tool::Degenerated(edge)) continue;
        const BRepAdaptor_Curve curve(edge);
        gp_Pnt middle;
        gp_Vec along;
        curve.D1(0.5 * (curve.FirstParameter() + curve.LastParameter()), middle, along);
        if (along.Magnitude() < 1e-12 || !select(middle, gp_Dir(along))) continue;
        add(operation, edge);
        any = true;
    }
    if (!any) return shape;
    try {
        operation.Build();
        if (operation.IsDone() && BRepCheck_Analyzer(operation.Shape()).IsValid()) return operation.Shape();
    } catch (const Standard_Failure&) {  // the radius is too large for OpenCASCADE
        return shape;
    }
    return shape;
}

}  // namespace

TopoDS_Shape fused(const TopoDS_Shape& a, const TopoDS_Shape& b) { return operate<BRepAlgoAPI_Fuse>(a, {b}); }

TopoDS_Shape fused(const std::vector<TopoDS_Shape>& parts) {
    if (parts.size() == 1) return parts.front();
    return operate<BRepAlgoAPI_Fuse>(parts.front(), {parts.begin() + 1, parts.end()});
}

TopoDS_Shape cut(const TopoDS_Shape& from, const TopoDS_Shape& what) {
    return operate<BRepAlgoAPI_Cut>(from, {what});
}

TopoDS_Shape cut(const TopoDS_Shape& from, const std::vector<TopoDS_Shape>& what) {
    return operate<BRepAlgoAPI_Cut>(from, what);
}

TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    return operate<BRepAlgoAPI_Common>(a, {b});
}

TopoDS_Shape rounded(const TopoDS_Shape& shape, double radius, const EdgeSelector& select) {
    return with_edges<BRepFilletAPI_MakeFillet>(
        shape, select, [&](auto& operation, const TopoDS_Edge& edge) { operation.Add(radius, edge); });
}

TopoDS_Shape bevelled(const TopoDS_Shape& shape, double width, const EdgeSelector& select) {
    return with_edges<BRepFilletAPI_MakeChamfer>(
        shape, select, [&](auto& operation, const TopoDS_Edge& edge) { operation.Add(width, edge); });
}

TopoDS_Shape glued(const TopoDS_Shape& a, const TopoDS_Shape& b) {
    BRepAlgoAPI_Fuse fuse;
    TopTools_ListOfShape arguments, tools;
    arguments.Append(a);
    tools.Append(b);
    fuse.SetArguments(arguments);
    fuse.SetTools(tools);
    fuse.SetGlue(BOPAlgo_GlueShift);
    fuse.Build();
    return fuse.Shape();
}

TopoDS_Shape only_solid(const TopoDS_Shape& shape) {
    TopoDS_Shape found;
    for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next()) {
        if (!found.IsNull()) return {};
        found = solids.Current();
    }
    return found;
}

bool is_valid_solid(const TopoDS_Shape& solid) {
    if (!BRepCheck_Analyzer(solid).IsValid()) return false;
    TopTools_IndexedDataMapOfShapeListOfShape faces;
    TopExp::MapShapesAndAncestors(solid, TopAbs_EDGE, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i)
        if (!BRep_Tool::Degenerated(TopoDS::Edge(faces.FindKey(i))) && faces(i).Extent() != 2) return false;
    return volume(solid) > 0.0;
}

double volume(const TopoDS_Shape& shape) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(shape, properties);
    return properties.Mass();
}

}  // namespace bolt::models
