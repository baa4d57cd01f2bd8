#include "tools/assets/models/fasteners.hpp"

#include <fmt/format.h>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax1.hxx>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"
#include "tools/assets/models/glyphs.hpp"
#include "tools/assets/models/screw_thread.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

namespace {

// Allowance of position g (ISO 965-1) on the diameter: 15 µm + 11 P. The bolt keeps the basic diameters of
// the tables. The nut is larger by the allowance, so that the pair has the clearance of 6H/6g.
double allowance(double pitch) { return 0.015 + 0.011 * pitch; }

// A hexagonal prism from z0 to z1, two flats facing ±X.
TopoDS_Shape hexagon(double across_flats, double z0, double z1) {
    BRepBuilderAPI_MakePolygon outline;
    const double corner = across_flats / std::sqrt(3.0);
    for (int i = 0; i < 6; ++i) {
        const double angle = pi / 6.0 + i * pi / 3.0;
        outline.Add(gp_Pnt(corner * std::cos(angle), corner * std::sin(angle), z0));
    }
    outline.Close();
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(outline.Wire()), gp_Vec(0.0, 0.0, z1 - z0));
}

// r (min) of ISO 4014, limited so that the washer of ISO 7089 still lies flat on the bearing face.
double head_fillet(double d) {
    const double r = d <= 4 ? 0.2 : d <= 6 ? 0.25 : d <= 10 ? 0.4 : d <= 18 ? 0.6 : d <= 24 ? 0.8 : 1.0;
    return std::min(r, d < 5 ? 0.15 : d < 8 ? 0.2 : d < 12 ? 0.25 : 0.5);
}

// A bolt without its thread: head, washer face, fillet and plain shank up to `shank_end`.
TopoDS_Shape head_and_shank(const BoltSpec& s, double shank_end) {
    const double corner = s.across_flats / std::sqrt(3.0) + 0.1;
    const double k = s.head_height, face = s.d < 8 ? 0.4 : s.d < 16 ? 0.5 : 0.6;
    const double top = 0.475 * s.across_flats, slope = std::tan(pi / 6.0);
    // A cone of 30° and the washer face bound the flats.
    const TopoDS_Shape turned = revolved(
        {{0.0, -k}, {top, -k}, {corner, -k + (corner - top) * slope}, {corner, -face}, {0.0, -face}});
    const TopoDS_Shape prism = BRepAlgoAPI_Common(hexagon(s.across_flats, -k, -face), turned);
    const double r = head_fillet(s.d), neck = 0.5 * s.d;
    ProfileOutline stem({0.0, -face});
    stem.line({0.5 * s.head_bearing, -face})
        .line({0.5 * s.head_bearing, 0.0})
        .line({neck + r, 0.0})
        .arc({neck + r * (1.0 - std::sqrt(0.5)), r * (1.0 - std::sqrt(0.5))}, {neck, r})
        .line({neck, shank_end})
        .line({0.0, shank_end});
    std::vector<TopoDS_Shape> parts = {prism, revolved(stem)};
    if (!s.grade.empty()) {  // ISO 898-1: raised by at most 0.1 d above k
        const double height = 0.17 * s.across_flats, raised = 0.015 * s.d;
        const gp_Trsf onto_head = shift(0.0, 0.0, -k) * turn(gp::OX(), pi);
        for (const TopoDS_Shape& stroke : text_strokes(s.grade, height, 0.2 * height, -0.2, raised))
            parts.push_back(moved(stroke, onto_head));
    }
    return fused(parts);
}

// The thread of a bolt from z0 to `length`. It has its full depth from `full_from` on.
ThreadField outer_thread(double d, double pitch, double z0, double full_from, double length) {
    const joint::ScrewThread thread = joint::metric_thread(d * mm, pitch * mm);
    ThreadField field;
    field.pitch = pitch;
    field.r_crest = 0.5 * d;
    field.r_root = 0.5 * thread.d3 / mm;
    field.crest_half_width = pitch / 16.0;
    field.half_angle = joint::thread_half_angle;
    field.z0 = z0;
    field.z1 = length;
    const double run_out = (field.r_crest - field.r_root) / (full_from - z0);
    field.at_least = {{field.r_crest + run_out * z0, 0.0, -run_out}};
    const double end = field.r_root - 0.1 * pitch;  // ISO 4753, chamfered end
    field.at_most = {{end + length, 0.0, -1.0}};
    return field;
}

// The rod, or its mirror image in the plane y = 0, in which a crest still passes z = 0 on the +X side.
Result<TopoDS_Shape> rod_with_thread(const ThreadField& field, ThreadDirection direction) {
    BOLT_TRY_ASSIGN(auto rod, threaded_rod(field));
    if (direction == ThreadDirection::right) return rod;
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp::Origin(), gp::DY()));
    return BRepBuilderAPI_Transform(rod, mirror, true).Shape();
}

// Between the size and the length in the name of a part.
const char* name_suffix(ThreadDirection direction) { return direction == ThreadDirection::left ? "-LH" : ""; }

Result<TopoDS_Shape> checked(const TopoDS_Shape& shape, std::string_view what) {
    TopoDS_Shape solid = only_solid(shape);
    if (solid.IsNull() || !is_valid_solid(solid))
        return fail(ErrorCode::failed, fmt::format("{}: is not one closed, valid solid", what),
                    "a solid of which OpenCASCADE reports no fault");
    return solid;
}

}  // namespace

Result<BoltSpec> iso_4014(std::string_view size, double length_mm) {
    BOLT_TRY_ASSIGN(const auto found, joint::parse_thread(size));
    const joint::FastenerSize& s = found.size;
    return BoltSpec{s.d / mm,
                    found.thread.pitch / mm,
                    length_mm,
                    joint::thread_length(s.d, length_mm * mm) / mm,
                    s.across_flats / mm,
                    s.head_height / mm,
                    s.head_bearing / mm,
                    {}};
}

Result<NutSpec> iso_4032(std::string_view size) {
    BOLT_TRY_ASSIGN(const auto found, joint::parse_thread(size));
    const joint::FastenerSize& s = found.size;
    return NutSpec{s.d / mm, found.thread.pitch / mm, s.nut_height / mm, s.across_flats / mm,
                   s.nut_bearing / mm};
}

Result<WasherSpec> iso_7089(std::string_view size) {
    BOLT_TRY_ASSIGN(const auto found, joint::parse_thread(size));
    const joint::FastenerSize& s = found.size;
    return WasherSpec{s.washer_inner / mm, s.washer_outer / mm, s.washer_thickness / mm};
}

Result<SocketScrewSpec> iso_4762(std::string_view size, double length_mm) {
    BOLT_TRY_ASSIGN(const auto found, joint::parse_thread(size));
    const joint::SocketHead* const head = joint::socket_head(found.size.name);
    if (head == nullptr)
        return fail(ErrorCode::bad_content,
                    fmt::format("socket screw {}: its head is not in the table", size), "M5 to M24");
    const double d = found.size.d / mm;
    const double thread_length = std::min(2.0 * d + 12.0, length_mm);  // ISO 4762: b = 2d + 12 mm
    return SocketScrewSpec{d,
                           found.thread.pitch / mm,
                           length_mm,
                           thread_length,
                           head->diameter / mm,
                           head->height / mm,
                           head->across_flats / mm};
}

Result<TopoDS_Shape> hex_bolt(const BoltSpec& spec, ThreadDetail detail) {
    const double full_from = std::max(spec.length - spec.thread_length, 2.0);
    const double shank_end =
        std::max(full_from - 2.0 * spec.pitch, 0.5 * full_from);  // ISO 4014: a run-out of at most 5 P
    const std::string name = fmt::format("bolt M{:g}x{:g}", spec.d, spec.length);
    if (detail == ThreadDetail::cosmetic) {
        const double c = 0.6 * spec.pitch;
        const TopoDS_Shape rod = revolved({{0.0, shank_end},
                                           {0.5 * spec.d, shank_end},
                                           {0.5 * spec.d, spec.length - c},
                                           {0.5 * spec.d - c, spec.length},
                                           {0.0, spec.length}});
        return checked(glued(head_and_shank(spec, shank_end), rod), name);
    }
    BOLT_TRY_ASSIGN(
        const auto rod,
        rod_with_thread(outer_thread(spec.d, spec.pitch, shank_end, full_from, spec.length), spec.direction));
    return checked(glued(head_and_shank(spec, shank_end), rod), name);
}

Result<TopoDS_Shape> hex_nut(const NutSpec& spec, ThreadDetail detail) {
    const double m = spec.height, corner = spec.across_flats / std::sqrt(3.0) + 0.1;
    const double bearing = 0.5 * spec.bearing, rise = (corner - bearing) * std::tan(pi / 6.0);
    const TopoDS_Shape turned =
        revolved({{0.0, 0.0}, {bearing, 0.0}, {corner, rise}, {corner, m - rise}, {bearing, m}, {0.0, m}});
    const TopoDS_Shape body = BRepAlgoAPI_Common(hexagon(spec.across_flats, 0.0, m), turned);

    const double extra = 0.5 * allowance(spec.pitch), beyond = 0.4637 * spec.pitch;
    const double countersink = 0.53 * spec.d, slope = std::tan(pi / 3.0);  // 1.06 d at 120°
    ThreadField bore;
    bore.pitch = spec.pitch;
    bore.r_crest = 0.5 * spec.d + extra;                                         // D
    bore.r_root = 0.5 * (spec.d - 0.625 * std::sqrt(3.0) * spec.pitch) + extra;  // D1
    bore.crest_half_width = spec.pitch / 16.0;
    bore.half_angle = joint::thread_half_angle;
    bore.z0 = -beyond;
    bore.z1 = m + beyond;
    bore.at_least = {{countersink, 0.0, -slope}, {countersink - slope * m, 0.0, slope}};
    const std::string name = fmt::format("nut M{:g}", spec.d);
    if (detail == ThreadDetail::cosmetic) {
        const double depth = (countersink - bore.r_root) / slope, mouth = countersink + slope * beyond;
        const TopoDS_Shape hole = revolved({{0.0, -beyond},
                                            {mouth, -beyond},
                                            {bore.r_root, depth},
                                            {bore.r_root, m - depth},
                                            {mouth, m + beyond},
                                            {0.0, m + beyond}});
        return checked(BRepAlgoAPI_Cut(body, hole), name);
    }
    BOLT_TRY_ASSIGN(const auto plug, rod_with_thread(bore, spec.direction));
    return checked(BRepAlgoAPI_Cut(body, plug), name);
}

Result<TopoDS_Shape> washer(const WasherSpec& spec) {
    const double edge = std::min(0.1, 0.05 * spec.thickness);  // stamped washers have broken edges
    const double ri = 0.5 * spec.inner, ro = 0.5 * spec.outer, h = spec.thickness;
    return checked(
        revolved({{ri, 0.0}, {ro - edge, 0.0}, {ro, edge}, {ro, h - edge}, {ro - edge, h}, {ri, h}}),
        "washer");
}

Result<TopoDS_Shape> stud(const StudSpec& spec) {
    const double full_from = std::max(spec.length - spec.thread_length, 2.0);
    const double shank_end = std::max(full_from - 2.0 * spec.pitch, 0.5 * full_from);
    const double c = 0.6 * spec.pitch;
    const TopoDS_Shape shank = revolved({{0.0, -spec.engagement},
                                         {0.5 * spec.d - c, -spec.engagement},
                                         {0.5 * spec.d, -spec.engagement + c},
                                         {0.5 * spec.d, shank_end},
                                         {0.0, shank_end}});
    BOLT_TRY_ASSIGN(
        const auto rod,
        rod_with_thread(outer_thread(spec.d, spec.pitch, shank_end, full_from, spec.length), spec.direction));
    return checked(glued(shank, rod), fmt::format("stud M{:g}x{:g}", spec.d, spec.length));
}

Result<TopoDS_Shape> socket_screw(const SocketScrewSpec& spec) {
    const double k = spec.head_height, ro = 0.5 * spec.head_diameter, round = 0.1 * spec.d;
    const double full_from = std::max(spec.length - spec.thread_length, 1.0);
    const double shank_end = std::max(full_from - 2.0 * spec.pitch, 0.5 * full_from);
    ProfileOutline outline({0.0, -k});
    outline.line({ro - round, -k})
        .arc({ro - round * (1.0 - std::sqrt(0.5)), -k + round * (1.0 - std::sqrt(0.5))}, {ro, -k + round})
        .line({ro, 0.0})
        .line({0.5 * spec.d, 0.0})
        .line({0.5 * spec.d, shank_end})
        .line({0.0, shank_end});
    const double corner = spec.socket / std::sqrt(3.0), depth = 0.5 * spec.d;
    TopoDS_Shape head = BRepAlgoAPI_Cut(revolved(outline), hexagon(spec.socket, -k - 1.0, -k + depth));
    const double tip = corner * std::tan(pi / 6.0);
    head = BRepAlgoAPI_Cut(head,
                           BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0.0, 0.0, -k - 0.001), gp::DZ()), corner * 1.04,
                                                corner * 0.9, corner * 0.14 * std::tan(pi / 6.0))
                               .Shape());
    head = BRepAlgoAPI_Cut(head, BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0.0, 0.0, -k + depth), gp::DZ()),
                                                      0.5 * spec.socket, 0.0, tip)
                                     .Shape());
    const std::string name = fmt::format("socket screw M{:g}x{:g}", spec.d, spec.length);
    const double c = 0.6 * spec.pitch;
    const TopoDS_Shape rod = revolved({{0.0, shank_end},
                                       {0.5 * spec.d, shank_end},
                                       {0.5 * spec.d, spec.length - c},
                                       {0.5 * spec.d - c, spec.length},
                                       {0.0, spec.length}});
    return checked(glued(head, rod), name);
}

Result<FastenerParts> add_fasteners(CadDocument& document, std::string_view size, double length_mm,
                                    Finish finish, const FastenerParts* shared, std::string_view grade,
                                    ThreadDirection direction) {
    BOLT_TRY_ASSIGN(auto bolt_spec, iso_4014(size, length_mm));
    bolt_spec.grade = grade;
    bolt_spec.direction = direction;
    const char* const hand = name_suffix(direction);
    BOLT_TRY_ASSIGN(const auto bolt, hex_bolt(bolt_spec));
    FastenerParts parts;
    if (shared != nullptr) parts = *shared;
    parts.bolt_spec = bolt_spec;
    parts.bolt = document.add_part(fmt::format("bolt_{}{}x{:g}", size, hand, length_mm), bolt, finish);
    if (shared != nullptr && shared->nut_spec.direction == direction) return parts;
    parts.nut_spec = *iso_4032(size);
    parts.nut_spec.direction = direction;
    parts.washer_spec = *iso_7089(size);
    BOLT_TRY_ASSIGN(const auto nut, hex_nut(parts.nut_spec));
    BOLT_TRY_ASSIGN(const auto disc, washer(parts.washer_spec));
    parts.nut = document.add_part(fmt::format("nut_{}{}", size, hand), nut, finish);
    if (shared == nullptr) parts.washer = document.add_part(fmt::format("washer_{}", size), disc, finish);
    return parts;
}

CadGroup add_joint(CadDocument& document, CadGroup parent, std::string_view id, const FastenerParts& parts,
                   double grip_mm, const gp_Trsf& placement) {
    const double h = parts.washer_spec.thickness;
    const CadGroup group = document.add_group(parent, fmt::format("joint_{}", id), placement);
    document.add_instance(group, fmt::format("{}_bolt", id), parts.bolt, shift(0.0, 0.0, -grip_mm - h));
    document.add_instance(group, fmt::format("{}_washer_head", id), parts.washer,
                          shift(0.0, 0.0, -grip_mm - h));
    document.add_instance(group, fmt::format("{}_washer_nut", id), parts.washer, gp_Trsf());
    gp_Trsf turned;
    turned.SetRotation(gp::OZ(),
                       nut_phase(grip_mm + 2.0 * h, parts.bolt_spec.pitch, parts.bolt_spec.direction));
    document.add_instance(group, fmt::format("{}_nut", id), parts.nut, shift(0.0, 0.0, h) * turned);
    return group;
}

double nut_phase(double dz, double pitch, ThreadDirection direction) {
    const double phase = 2.0 * pi * std::fmod(dz, pitch) / pitch;
    return direction == ThreadDirection::left ? -phase : phase;
}

}  // namespace bolt::models
