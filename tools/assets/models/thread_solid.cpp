#include "tools/assets/models/screw_thread.hpp"

#include <BRepCheck_Analyzer.hxx>
#include <BRep_Builder.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_Circle.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Wire.hxx>
#include <cmath>
#include <map>
#include <math_Gauss.hxx>
#include <math_Matrix.hxx>
#include <math_Vector.hxx>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::models {

namespace {

constexpr double tolerance = 1e-4;  // mm
constexpr int degree = 11;  // over half a turn one polynomial is within 1e-8 mm of a helix of diameter 40 mm

gp_Pnt at(double theta, double z, double r) { return {r * std::cos(theta), r * std::sin(theta), z}; }

// Bézier poles of the polynomial that passes through the points at the parameters (1 − cos(iπ/n))/2.
std::vector<gp_Pnt> poles_through(const std::vector<gp_Pnt>& points) {
    math_Matrix bernstein(1, degree + 1, 1, degree + 1);
    for (int i = 0; i <= degree; ++i) {
        const double t = 0.5 * (1.0 - std::cos(i * pi / degree));
        double binomial = 1.0;
        for (int j = 0; j <= degree; ++j) {
            bernstein(i + 1, j + 1) = binomial * std::pow(t, j) * std::pow(1.0 - t, degree - j);
            binomial *= static_cast<double>(degree - j) / (j + 1);
        }
    }
    const math_Gauss solver(bernstein);
    std::vector<gp_Pnt> poles(points.size());
    for (int axis = 1; axis <= 3; ++axis) {
        math_Vector values(1, degree + 1), solved(1, degree + 1);
        for (int i = 0; i <= degree; ++i) values(i + 1) = points[static_cast<std::size_t>(i)].Coord(axis);
        solver.Solve(values, solved);
        for (int i = 0; i <= degree; ++i) poles[static_cast<std::size_t>(i)].SetCoord(axis, solved(i + 1));
    }
    poles.front() = points.front();
    poles.back() = points.back();
    return poles;
}

// The curve along which θ, z and r change linearly, over at most half a turn. Its parameter is θ.
Handle(Geom_BSplineCurve)
    conical_helix(double theta0, double z0, double r0, double theta1, double z1, double r1) {
    std::vector<gp_Pnt> points;
    for (int i = 0; i <= degree; ++i) {
        const double t = 0.5 * (1.0 - std::cos(i * pi / degree));
        points.push_back(at(theta0 + t * (theta1 - theta0), z0 + t * (z1 - z0), r0 + t * (r1 - r0)));
    }
    const std::vector<gp_Pnt> found = poles_through(points);
    TColgp_Array1OfPnt poles(1, degree + 1);
    for (int i = 0; i <= degree; ++i) poles(i + 1) = found[static_cast<std::size_t>(i)];
    TColStd_Array1OfReal knots(1, 2);
    knots(1) = theta0;
    knots(2) = theta1;
    TColStd_Array1OfInteger multiplicities(1, 2);
    multiplicities.Init(degree + 1);
    return new Geom_BSplineCurve(poles, knots, multiplicities, degree);
}

// A surface of the field, and the linear map from (θ, z) to its parameters, which keeps straight lines
// straight.
struct FieldSurface {
    Handle(Geom_Surface) geometry;
    double u_sign = 1.0, u_offset = 0.0;  // u = u_offset + u_sign θ
    double v0 = 0.0, v_theta = 0.0, v_z = 0.0;
    bool outward = true;  // the normal of `geometry` points out of the rod

    [[nodiscard]] gp_Pnt2d uv(double theta, double z) const {
        return {u_offset + u_sign * theta, v0 + v_theta * theta + v_z * z};
    }
};

FieldSurface surface_of(const FieldPlane& plane, int sector, double r_low, double r_high) {
    FieldSurface surface;
    if (plane.r_theta == 0.0 && plane.r_z == 0.0) {
        surface.geometry = new Geom_CylindricalSurface(gp_Ax3(gp::XOY()), plane.r0);
        surface.v_z = 1.0;
    } else if (plane.r_theta == 0.0) {
        // STEP requires a positive half angle, so a cone that narrows upwards is placed upside down.
        const bool widens = plane.r_z > 0.0;
        const double angle = std::atan(std::abs(plane.r_z));
        const double radius = 1.0;  // any point of the cone can be its origin
        const double z = (radius - plane.r0) / plane.r_z;
        const gp_Ax3 frame(gp_Pnt(0.0, 0.0, z), gp_Dir(0.0, 0.0, widens ? 1.0 : -1.0), gp::DX());
        surface.geometry = new Geom_ConicalSurface(frame, angle, radius);
        surface.u_sign = widens ? 1.0 : -1.0;
        surface.u_offset = widens ? 0.0 : 2.0 * pi;
        surface.v_z = (widens ? 1.0 : -1.0) / std::cos(angle);
        surface.v0 = -z * surface.v_z;
    } else {
        const double from = sector * pi, to = from + pi;
        const auto z = [&](double theta, double r) {
            return (r - plane.r0 - plane.r_theta * theta) / plane.r_z;
        };
        const auto low = conical_helix(from, z(from, r_low), r_low, to, z(to, r_low), r_low);
        const auto high = conical_helix(from, z(from, r_high), r_high, to, z(to, r_high), r_high);
        TColgp_Array2OfPnt poles(1, low->NbPoles(), 1, 2);
        for (int i = 1; i <= low->NbPoles(); ++i) {
            poles.SetValue(i, 1, low->Pole(i));
            poles.SetValue(i, 2, high->Pole(i));
        }
        TColStd_Array1OfReal v_knots(1, 2);
        v_knots(1) = r_low;
        v_knots(2) = r_high;
        TColStd_Array1OfInteger v_multiplicities(1, 2);
        v_multiplicities.Init(2);
        surface.geometry = new Geom_BSplineSurface(poles, low->Knots(), v_knots, low->Multiplicities(),
                                                   v_multiplicities, low->Degree(), 1);
        surface.v0 = plane.r0;
        surface.v_theta = plane.r_theta;
        surface.v_z = plane.r_z;
    }
    gp_Pnt p;
    gp_Vec du, dv;
    double u0, u1, v0, v1;
    surface.geometry->Bounds(u0, u1, v0, v1);
    const double v = surface.v_theta != 0.0 ? 0.5 * (v0 + v1) : 0.0;
    surface.geometry->D1(0.5 * (u0 + u1), v, p, du, dv);
    surface.outward = du.Crossed(dv).Dot(gp_Vec(p.X(), p.Y(), 0.0)) > 0.0;
    return surface;
}

// Builds the solid of a thread from its polygons.
struct RodBuilder {
    const ThreadField& field;
    const FieldMesh& mesh;
    BRep_Builder build;
    std::vector<TopoDS_Vertex> vertices;
    // Edges by lower vertex, higher vertex and sector (−1 for an edge along z, which two sectors share).
    std::map<std::tuple<int, int, int>, TopoDS_Edge> edges;
    TopoDS_Shell shell;

    [[nodiscard]] const FieldVertex& corner(int v) const {
        return mesh.vertices[static_cast<std::size_t>(v)];
    }

    // The edge between two corners of a face. It runs in the direction of increasing θ, or of z if θ is
    // constant.
    struct FaceEdge {
        TopoDS_Edge edge;
        double t0, t1;         // parameters of the ends
        gp_Pnt2d first, last;  // θ, z at its ends
        bool forward;          // the face uses the edge in its own direction
    };

    FaceEdge face_edge(int a, int b, int sector) {
        const double theta_a = theta_in_sector(corner(a), sector),
                     theta_b = theta_in_sector(corner(b), sector);
        const bool along_z = std::abs(theta_a - theta_b) < 1e-7;
        const bool forward = along_z ? corner(a).z < corner(b).z : theta_a < theta_b;
        const int first = forward ? a : b, last = forward ? b : a;
        const FieldVertex &p = corner(first), &q = corner(last);
        const double theta0 = theta_in_sector(p, sector), theta1 = theta_in_sector(q, sector);
        const gp_Pnt start = at(p.theta, p.z, p.r), end = at(q.theta, q.z, q.r);
        FaceEdge result{{},
                        along_z ? 0.0 : theta0,
                        along_z ? start.Distance(end) : theta1,
                        {theta0, p.z},
                        {theta1, q.z},
                        forward};
        TopoDS_Edge& edge = edges[{std::min(a, b), std::max(a, b), along_z ? -1 : sector}];
        if (edge.IsNull()) {
            if (along_z)
                build.MakeEdge(edge, new Geom_Line(start, gp_Dir(gp_Vec(start, end))), tolerance);
            else if (std::abs(p.z - q.z) < 1e-9 && std::abs(p.r - q.r) < 1e-9)
                build.MakeEdge(edge, new Geom_Circle(gp_Ax2(gp_Pnt(0.0, 0.0, p.z), gp::DZ(), gp::DX()), p.r),
                               tolerance);
            else
                build.MakeEdge(edge, conical_helix(theta0, p.z, p.r, theta1, q.z, q.r), tolerance);
            build.Add(edge, vertices[static_cast<std::size_t>(first)].Oriented(TopAbs_FORWARD));
            build.Add(edge, vertices[static_cast<std::size_t>(last)].Oriented(TopAbs_REVERSED));
            build.Range(edge, result.t0, result.t1);
        }
        result.edge = edge;
        return result;
    }

    void add(TopoDS_Face face, const TopoDS_Wire& wire, bool outward) {
        build.Add(face, outward ? wire : TopoDS::Wire(wire.Reversed()));
        build.Add(shell, outward ? face : TopoDS::Face(face.Reversed()));
    }

    void add(const FieldFace& polygon) {
        const FieldSurface surface = surface_of(polygon.plane, polygon.sector, field.r_root, field.r_crest);
        TopoDS_Face face;
        build.MakeFace(face, surface.geometry, tolerance);
        TopoDS_Wire wire;
        build.MakeWire(wire);
        for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            const FaceEdge s = face_edge(polygon.corners[i],
                                         polygon.corners[(i + 1) % polygon.corners.size()], polygon.sector);
            const gp_Pnt2d from = surface.uv(s.first.X(), s.first.Y()),
                           to = surface.uv(s.last.X(), s.last.Y());
            // The parameter of a line is its length; that of the edge is θ, or the length along z.
            const gp_Vec2d step(from, to);
            TColgp_Array1OfPnt2d poles(1, 2);
            poles(1) = from;
            poles(2) = to;
            TColStd_Array1OfReal knots(1, 2);
            knots(1) = s.t0;
            knots(2) = s.t1;
            TColStd_Array1OfInteger multiplicities(1, 2);
            multiplicities.Init(2);
            Handle(Geom2d_Curve) curve;
            if (std::abs(step.Magnitude() - (s.t1 - s.t0)) < 1e-12)
                curve = new Geom2d_Line(from.Translated(-s.t0 * step / step.Magnitude()), gp_Dir2d(step));
            else
                curve = new Geom2d_BSplineCurve(poles, knots, multiplicities, 1);
            build.UpdateEdge(s.edge, curve, face, tolerance);
            build.Range(s.edge, face, s.t0, s.t1);
            build.Add(wire, s.edge.Oriented(s.forward ? TopAbs_FORWARD : TopAbs_REVERSED));
        }
        wire.Closed(Standard_True);
        add(face, wire, surface.outward);
    }

    // Adds a flat end: chains all edges at height z to one wire.
    void add_end(double z, bool top) {
        TopoDS_Face face;
        build.MakeFace(face, new Geom_Plane(gp_Ax3(gp_Pnt(0.0, 0.0, z), gp::DZ(), gp::DX())), tolerance);
        TopoDS_Wire wire;
        build.MakeWire(wire);
        std::map<double, TopoDS_Edge> around;
        for (const auto& [key, edge] : edges) {
            const auto [a, b, sector] = key;
            if (sector < 0 || std::abs(corner(a).z - z) > 1e-7 || std::abs(corner(b).z - z) > 1e-7) continue;
            const double theta =
                std::min(theta_in_sector(corner(a), sector), theta_in_sector(corner(b), sector));
            around[top ? theta : -theta] = edge;
        }
        for (const auto& [theta, edge] : around)
            build.Add(wire, edge.Oriented(top ? TopAbs_FORWARD : TopAbs_REVERSED));
        wire.Closed(Standard_True);
        add(face, wire, top);
    }
};

}  // namespace

Result<TopoDS_Shape> threaded_rod(const ThreadField& field) {
    const FieldMesh mesh = thread_polygons(field);
    RodBuilder builder{field, mesh, {}, {}, {}, {}};
    builder.build.MakeShell(builder.shell);
    for (const FieldVertex& vertex : mesh.vertices) {
        TopoDS_Vertex corner;
        builder.build.MakeVertex(corner, at(vertex.theta, vertex.z, vertex.r), tolerance);
        builder.vertices.push_back(corner);
    }
    for (const FieldFace& face : mesh.faces) builder.add(face);
    builder.add_end(field.z0, false);
    builder.add_end(field.z1, true);
    builder.shell.Closed(Standard_True);
    TopoDS_Solid solid;
    builder.build.MakeSolid(solid);
    builder.build.Add(solid, builder.shell);
    if (!BRepCheck_Analyzer(solid).IsValid())
        return fail(ErrorCode::failed, "the thread is not a valid solid",
                    "a pitch and lengths that are consistent");
    return TopoDS_Shape(solid);
}

}  // namespace bolt::models
