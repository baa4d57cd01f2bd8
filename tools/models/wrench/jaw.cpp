#include "tools/models/wrench/jaw.hpp"

#include <fmt/format.h>

#include <cmath>

#include "engine/base/math.hpp"
#include "tools/models/glyphs.hpp"
#include "tools/models/solids.hpp"

namespace bolt::models {

namespace {

struct Head {
    double radius, middle;  // of the disc, which lies a little behind the jaw
    double tip;             // where the jaws end
    double throat;          // where the jaw ends
    double half;            // of its opening
};

Head head_of(const WrenchSpec& s) {
    return {0.5 * s.head_width, 0.05 * s.size, -0.7 * s.size, 0.6 * s.size, 0.5 * s.jaw};
}

}  // namespace

TopoDS_Shape forged_head(const WrenchSpec& s) {
    const Head h = head_of(s);
    const double high = s.head_thickness, R = h.radius;
    const TopoDS_Shape disc =
        cut(cylinder(gp_Ax2(gp_Pnt(h.middle, 0.0, -high), gp::DZ()), R, 2.0 * high),
            box(gp_Pnt(-3.0 * R, -2.0 * R, -2.0 * high), gp_Pnt(h.tip, 2.0 * R, 2.0 * high)));
    return rounded(disc, 0.22 * s.size, [&](const gp_Pnt& p, const gp_Dir& along) {
        return upright(along) && std::abs(p.X() - h.tip) < 1e-6;
    });
}

TopoDS_Shape with_jaw(const TopoDS_Shape& forging, const WrenchSpec& s) {
    const Head h = head_of(s);
    const double high = s.head_thickness;
    const gp_Trsf to_head = turn(gp::OZ(), s.head_angle), from_head = to_head.Inverted();
    // Parallel flats, and a rounded throat clear of the corners of the hexagon; `wider` all round.
    const auto slot = [&](double wider, double z0, double z1) {
        const double end = h.throat + wider;
        const TopoDS_Shape block =
            box(gp_Pnt(-4.0 * h.radius, -h.half - wider, z0), gp_Pnt(end, h.half + wider, z1));
        return rounded(block, 0.29 * s.size + wider, [&](const gp_Pnt& p, const gp_Dir& along) {
            return upright(along) && std::abs(p.X() - end) < 1e-6;
        });
    };
    TopoDS_Shape body = cut(forging, moved(slot(0.0, -high, high), to_head));
    body = rounded(body, 0.06 * s.size, [&](const gp_Pnt& p, const gp_Dir& along) {  // lead-in at the tips
        const gp_Pnt q = p.Transformed(from_head);
        return upright(along) && std::abs(q.X() - h.tip) < 1e-3 && std::abs(std::abs(q.Y()) - h.half) < 1e-3;
    });
    // The edges of the jaw are broken: a shallow wider slot whose walls lean by 45° down past the jaw's own.
    const double c = 0.025 * s.size, deep = 2.0 * c, floor = 0.5 * s.head_thickness - deep;
    const TopoDS_Shape lean = bevelled(slot(c, floor, high), deep, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(p.Z() - floor) < 1e-6 && p.X() > -3.9 * h.radius;
    });
    const TopoDS_Shape below = moved(lean, turn(gp::OX(), pi));
    return cut(body, {moved(lean, to_head), moved(below, to_head)});
}

std::vector<TopoDS_Shape> size_stamps(const WrenchSpec& s) {
    const Head h = head_of(s);
    const gp_Trsf to_head = turn(gp::OZ(), s.head_angle);
    const gp_Trsf place =
        to_head * shift(0.5 * (h.throat + h.middle + h.radius), 0.0, 0.0) * turn(gp::OZ(), -0.5 * pi);
    const gp_Trsf below = to_head * turn(gp::OX(), pi) * to_head.Inverted();
    const double face = 0.5 * s.head_thickness, height = 0.2 * s.size;
    std::vector<TopoDS_Shape> stamps;
    for (const TopoDS_Shape& stroke :
         text_strokes(fmt::format("{:g}", s.size), height, 0.17 * height, face - 0.35, face + 1.0)) {
        stamps.push_back(moved(stroke, place));
        stamps.push_back(moved(stamps.back(), below));
    }
    return stamps;
}

}  // namespace bolt::models
