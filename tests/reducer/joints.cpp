// Tests of the twelve joints: the CAD model has hole, seat and fasteners where assembly.json places them.
#include <doctest/doctest.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Section.hxx>
#include <GCPnts_UniformAbscissa.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <map>
#include <numbers>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "shipped.hpp"
#include "tools/assets/models/reducer/layout.hpp"

namespace reducer_joints_test {

namespace {

using namespace reducer_test;
using bolt::models::reducer::bolt_hole;
using bolt::models::reducer::JointLayout;
constexpr double pi = std::numbers::pi;

// A joint of assembly.json in the CAD's frame and unit: glTF (x, y, z) = (X, Z, -Y) / 1000.
struct CadJoint {
    std::string id;
    double x, y, z;
    double upper, lower;  // thickness of the two members
    double bolt_length;
};

const std::vector<CadJoint>& joints() {
    static const std::vector<CadJoint> all = [] {
        const auto path = bolt::content::content_folder() / "assemblies/zq350/assembly.json";
        const auto text = bolt::read_file(path, 1U << 20U, bolt::ErrorCode::bad_content);
        REQUIRE(text.has_value());
        const auto loaded = bolt::content::parse_assembly(*text, path.string());
        REQUIRE(loaded.ok());
        std::vector<CadJoint> list;
        for (const auto& joint : loaded.assembly.joints) {
            const auto& d = joint.design;
            CHECK(joint.node == "joint_" + d.id);
            CHECK(d.axis.y == 1.0);
            REQUIRE(d.members.size() == 2);
            CHECK(d.washer_under_nut);  // the seat is the washer's top; position_mm is under the washer
            const double under_washer = d.seat.y - d.thread.size.washer_thickness;
            list.push_back({d.id, d.seat.x * 1e3, -d.seat.z * 1e3, under_washer * 1e3,
                            d.members[1].thickness * 1e3, d.members[0].thickness * 1e3, d.bolt_length * 1e3});
        }
        REQUIRE(list.size() == 12);
        return list;
    }();
    return all;
}

// Cylindrical faces about an axis parallel to Z within 0.01 mm of (x, y).
int holes_at(const TopoDS_Shape& shape, double x, double y, double diameter) {
    int found = 0;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(faces.Current()));
        if (surface.GetType() != GeomAbs_Cylinder) continue;
        const gp_Cylinder c = surface.Cylinder();
        if (std::abs(std::abs(c.Axis().Direction().Z()) - 1.0) > 1e-9) continue;
        if (std::hypot(c.Location().X() - x, c.Location().Y() - y) < 0.01 &&
            std::abs(2.0 * c.Radius() - diameter) < 1e-6)
            ++found;
    }
    return found;
}

// Points every millimetre along the upper casing's outline, at three heights of a nut on a seat at z.
const std::vector<gp_Pnt>& outline_above(double z) {
    static std::map<double, std::vector<gp_Pnt>> made;
    const auto [at, is_new] = made.try_emplace(z);
    std::vector<gp_Pnt>& points = at->second;
    if (!is_new) return points;
    for (const double height : {5.0, 10.0, 15.0}) {
        BRepAlgoAPI_Section section(part("casing_upper"), gp_Pln(gp_Pnt(0, 0, z + height), gp_Dir(0, 0, 1)));
        REQUIRE(section.IsDone());
        for (TopExp_Explorer edges(section.Shape(), TopAbs_EDGE); edges.More(); edges.Next()) {
            const BRepAdaptor_Curve curve(TopoDS::Edge(edges.Current()));
            const GCPnts_UniformAbscissa even(curve, 1.0);
            if (!even.IsDone()) continue;
            for (int i = 1; i <= even.NbPoints(); ++i) points.push_back(curve.Value(even.Parameter(i)));
        }
    }
    return points;
}

}  // namespace

TEST_CASE("Reducer joints: both halves have a bolt hole of 17.5 mm within 0.01 mm of the joint's axis") {
    for (const CadJoint& j : joints()) {
        CAPTURE(j.id);
        for (const char* half : {"casing_upper", "casing_lower"}) {
            CHECK(holes_at(part(half), j.x, j.y, bolt_hole) >= 1);
            CHECK(holes_at(part(half), j.x + 0.02, j.y, bolt_hole) == 0);
            CHECK(crossings_z(part(half), j.x, j.y).empty());  // the hole is empty
        }
    }
}

TEST_CASE("Reducer joints: under washer and head the members have the thickness of assembly.json") {
    for (const CadJoint& j : joints())
        for (const double radius : {9.5, 12.0, 14.9})
            for (int i = 0; i < 12; ++i) {
                const double x = j.x + radius * std::cos(i * pi / 6.0),
                             y = j.y + radius * std::sin(i * pi / 6.0);
                CAPTURE(j.id);
                const auto upper = crossings_z(part("casing_upper"), x, y);
                const auto lower = crossings_z(part("casing_lower"), x, y);
                REQUIRE(upper.size() >= 2);
                REQUIRE(lower.size() >= 2);
                CHECK(std::abs(upper.back() - j.z) < 0.01);
                CHECK(std::abs(upper.back() - upper.front() - j.upper) < 0.01);
                CHECK(std::abs(upper.front()) < 0.01);
                CHECK(std::abs(lower.back()) < 0.01);
                // A screw hole of an end cap may lie in between, and a foot further down, so any crossing may
                // be the seat.
                CHECK(std::any_of(lower.begin(), lower.end(),
                                  [&](double z) { return std::abs(z + j.lower) < 0.01; }));
            }
}

TEST_CASE("Reducer joints: bolt, washers and nut are on the joint's axis at their seats") {
    for (const CadJoint& j : joints()) {
        CAPTURE(j.id);
        const struct {
            const char* piece;
            double low, high;  // ISO 7089 washers of 3 mm
        } pieces[] = {{"_washer_nut", j.z, j.z + 3.0}, {"_washer_head", -j.lower - 3.0, -j.lower}};
        for (const auto& p : pieces) {
            const std::string name = j.id + p.piece;
            CHECK(shipped().at(name).path == "/joint_" + j.id);
            const auto z = crossings_z(part(name), j.x + 12.0, j.y);
            REQUIRE(z.size() == 2);
            CHECK(std::abs(z[0] - p.low) < 0.01);
            CHECK(std::abs(z[1] - p.high) < 0.01);
        }
        const auto nut = crossings_z(part(j.id + "_nut"), j.x + 10.5, j.y);
        REQUIRE(nut.size() == 2);
        CHECK(std::abs(nut[0] - j.z - 3.0) < 0.01);
        const auto bolt = crossings_z(part(j.id + "_bolt"), j.x, j.y);
        REQUIRE(bolt.size() == 2);
        CHECK(std::abs(bolt[1] - (-j.lower - 3.0 + j.bolt_length)) < 0.01);
        CHECK(bolt[1] > nut[1]);  // the point protrudes above the nut
    }
}

TEST_CASE("Reducer joints: a 24 mm wrench has at least 30 degrees free at every nut") {
    // The wrench seen from above: a head of 53 mm diameter and a handle 26 mm wide up to 255 mm. Two settings
    // on a hexagon are 60 degrees apart; a head at 15 degrees, turned over, halves that to 30.
    constexpr double head = 26.5, handle = 13.0, length = 255.0;
    for (const CadJoint& j : joints()) {
        CAPTURE(j.id);
        std::vector<gp_Pnt> obstacles = outline_above(j.z);
        REQUIRE(!obstacles.empty());
        for (const CadJoint& other : joints())
            if (other.id != j.id && std::abs(other.z - j.z) < 20.0)
                for (int i = 0; i < 24; ++i)
                    obstacles.emplace_back(other.x + 13.9 * std::cos(i * pi / 12.0),
                                           other.y + 13.9 * std::sin(i * pi / 12.0), j.z);
        std::vector<bool> free(144, true);
        for (std::size_t k = 0; k < free.size(); ++k) {
            const double angle = static_cast<double>(k) * 2.0 * pi / 144.0, c = std::cos(angle),
                         s = std::sin(angle);
            for (const gp_Pnt& p : obstacles) {
                const double dx = p.X() - j.x, dy = p.Y() - j.y, along = c * dx + s * dy,
                             across = c * dy - s * dx;
                if (std::hypot(dx, dy) < head || (along > 0.0 && along < length && std::abs(across) < handle))
                    free[k] = false;
            }
        }
        std::size_t best = 0, run = 0;
        for (std::size_t k = 0; k < 2 * free.size(); ++k) {
            run = free[k % free.size()] ? run + 1 : 0;
            best = std::max(best, std::min(run, free.size()));
        }
        MESSAGE(j.id << ": " << 2.5 * static_cast<double>(best) << " degrees free");
        CHECK(2.5 * static_cast<double>(best) >= 30.0);
    }
}

}  // namespace reducer_joints_test
