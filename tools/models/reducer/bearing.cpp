#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <numbers>

#include "tools/models/reducer/drive.hpp"
#include "tools/models/reducer/shapes.hpp"

namespace bolt::models::reducer {

// ISO 15 fixes bore, outer diameter and width; the inside follows common practice: rollers half as thick as
// the section, filling their circle but for the cage, two ribs on the outer ring, one on the inner.
Result<TopoDS_Shape> roller_bearing(double bore, double outer, double width) {
    return guarded("roller bearing", [&] {
        const gp_Ax2 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
        const double pitch = (bore + outer) / 4.0, half = width / 2.0, chamfer = 1.2;
        const double roller = (outer - bore) / 8.0, length = 0.56 * width, side = length / 2.0 + 0.1,
                     play = 0.02;
        const double rib = 0.6 * roller, in = bore / 2.0, out = outer / 2.0;
        const double in_race = pitch - roller - play, out_race = pitch + roller + play;
        const int rollers = static_cast<int>(std::floor(std::numbers::pi * pitch / (1.18 * roller)));
        TopoDS_Compound bearing;
        BRep_Builder builder;
        builder.MakeCompound(bearing);
        builder.Add(bearing, one_solid("inner ring", revolved(axis, {{in + chamfer, -half},
                                                                     {in_race, -half},
                                                                     {in_race, side},
                                                                     {in_race + rib, side},
                                                                     {in_race + rib, half},
                                                                     {in + chamfer, half},
                                                                     {in, half - chamfer},
                                                                     {in, chamfer - half}})));
        builder.Add(bearing, one_solid("outer ring", revolved(axis, {{out - chamfer, -half},
                                                                     {out, chamfer - half},
                                                                     {out, half - chamfer},
                                                                     {out - chamfer, half},
                                                                     {out_race - rib, half},
                                                                     {out_race - rib, side},
                                                                     {out_race, side},
                                                                     {out_race, -side},
                                                                     {out_race - rib, -side},
                                                                     {out_race - rib, -half}})));
        for (const double end : {-1.0, 1.0}) {
            const double z0 = end * (side + 0.1), z1 = end * (side + 2.0), r = 0.3 * roller;
            builder.Add(bearing,
                        revolved(axis, {{pitch - r, z0}, {pitch + r, z0}, {pitch + r, z1}, {pitch - r, z1}}));
        }
        for (int i = 0; i < rollers; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / rollers;
            const gp_Pnt at(pitch * std::cos(angle), pitch * std::sin(angle), -length / 2.0);
            builder.Add(bearing, cylinder(gp_Ax2(at, gp_Dir(0, 0, 1)), roller, length));
        }
        return TopoDS_Shape(bearing);
    });
}

}  // namespace bolt::models::reducer
