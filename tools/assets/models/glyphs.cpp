#include "tools/assets/models/glyphs.hpp"

#include <algorithm>
#include <cmath>
#include <gp_Ax2.hxx>
#include <string>

#include "game/tool_models/glyphs.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

double text_width(std::string_view text, double height) { return tool_models::text_width(text, height); }

std::vector<TopoDS_Shape> text_strokes(std::string_view text, double height, double stroke, double z0,
                                       double z1) {
    // The shipped heads have no points in "8.8": a change of these files would invalidate recorded sessions,
    // which store their checksums.
    std::string without_points(text);
    std::replace(without_points.begin(), without_points.end(), '.', ' ');
    std::vector<TopoDS_Shape> result;
    for (const tool_models::PlacedStroke& line : tool_models::text_lines(without_points, height)) {
        std::vector<TopoDS_Shape> pieces;
        for (std::size_t i = 0; i < line.size(); ++i) {
            const auto at = [&](std::size_t k) { return gp_Pnt(line[k].x, line[k].y, z0); };
            pieces.push_back(cylinder(gp_Ax2(at(i), gp::DZ()), 0.5 * stroke, z1 - z0));
            if (i + 1 == line.size()) continue;
            const gp_Pnt a = at(i), b = at(i + 1);
            const TopoDS_Shape bar =
                box(gp_Pnt(0.0, -0.5 * stroke, 0.0), gp_Pnt(a.Distance(b), 0.5 * stroke, z1 - z0));
            gp_Trsf placement = shift(a.X(), a.Y(), a.Z());
            placement.Multiply(turn(gp::OZ(), std::atan2(b.Y() - a.Y(), b.X() - a.X())));
            pieces.push_back(moved(bar, placement));
        }
        result.push_back(fused(pieces));
    }
    return result;
}

}  // namespace bolt::models
