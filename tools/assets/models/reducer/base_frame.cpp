// The base frame of the reducer with its foot bolts: a model of its own, in the frame of the reducer's,
// because only the lesson about the foot bolts shows it.
#include <fmt/format.h>

#include <gp_Ax3.hxx>
#include <string>

#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/reducer/layout.hpp"
#include "tools/assets/models/reducer/shapes.hpp"
#include "tools/assets/models/shipped.hpp"

namespace bolt::models::reducer {
namespace {

// Two rails under the feet and two cross beams beside the sump, welded from bars of one height. No standard.
constexpr double frame_left = -112.0, frame_right = 462.0, rail_inner = 60.0, rail_outer = 188.0;
constexpr double beam_width = 50.0, frame_height = 50.0, frame_edge = 3.0;
constexpr double tapped_depth = 40.0, tapped_hole = 20.05;  // the thread is its outside cylinder

struct FootBolt {
    double x = 0.0, y = 0.0;
};

// A1 to A4 are on the -Y side, A5 to A8 on the +Y side, each from the input to the output.
std::vector<FootBolt> foot_bolts() {
    std::vector<FootBolt> bolts;
    for (const double y : {-foot_hole_y, foot_hole_y})
        for (const double x : feet)
            for (const double dx : {-foot_hole_offset, foot_hole_offset}) bolts.push_back({x + dx, y});
    return bolts;
}

Result<TopoDS_Shape> base_frame() {
    return catch_build_errors("base frame", [] {
        const double low = sole_z - frame_height;
        const TopoDS_Shape whole = merged_faces(
            fused({box({frame_left, frame_right, -rail_outer, -rail_inner, low, sole_z}),
                   box({frame_left, frame_right, rail_inner, rail_outer, low, sole_z}),
                   box({frame_left, frame_left + beam_width, -rail_outer, rail_outer, low, sole_z}),
                   box({frame_right - beam_width, frame_right, -rail_outer, rail_outer, low, sole_z})}));
        const TopoDS_Shape frame = chamfered("base frame", whole, frame_edge, [](const TopoDS_Edge& edge) {
            return in_plane_z(edge, sole_z);
        });
        Shapes drills;
        for (const FootBolt& bolt : foot_bolts())
            drills.push_back(
                cylinder_z(bolt.x, bolt.y, sole_z - tapped_depth, sole_z + 1.0, 0.5 * tapped_hole));
        return one_solid("base frame", cut(frame, drills));
    });
}

}  // namespace
}  // namespace bolt::models::reducer

namespace bolt::models {

Status add_zq350_base(CadDocument& document) {
    using namespace reducer;
    BOLT_TRY_ASSIGN(const auto frame, base_frame());
    document.add_instance(document.root(), "base_frame",
                          document.add_part("base_frame", frame, finish::gear_steel));
    BOLT_TRY_ASSIGN(const auto spec, iso_4014("M20", 60.0));
    BOLT_TRY_ASSIGN(const auto screw_shape, hex_bolt(spec, ThreadDetail::cosmetic));
    BOLT_TRY_ASSIGN(const auto ring, iso_7089("M20"));
    BOLT_TRY_ASSIGN(const auto washer_shape, washer(ring));
    const CadPart screw = document.add_part("screw_M20x60", screw_shape, finish::zinc_plated);
    const CadPart disc = document.add_part("washer_M20", washer_shape, finish::zinc_plated);
    gp_Trsf head_up;  // the head above the washer
    head_up.SetTransformation(gp_Ax3(gp_Pnt(0, 0, ring.thickness), gp_Dir(0, 0, -1), gp_Dir(1, 0, 0)),
                              gp_Ax3());
    int number = 0;
    for (const FootBolt& bolt : foot_bolts()) {
        const std::string id = fmt::format("A{}", ++number);
        gp_Trsf seat;
        seat.SetTranslation(gp_Vec(bolt.x, bolt.y, sole_z + foot_thickness - foot_spot_depth));
        const CadGroup joint = document.add_group(document.root(), "joint_" + id, seat);
        document.add_instance(joint, id + "_washer_head", disc);
        document.add_instance(joint, id + "_bolt", screw, head_up);
    }
    return {};
}

}  // namespace bolt::models
