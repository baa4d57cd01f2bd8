// Open-end wrenches with a forged appearance. Their proportions follow common tools and no standard.
// Millimetres.
// Frame: origin in the middle of the jaw at mid thickness, +X along the handle, +Z normal to the flat. The
// mouth opens towards −X turned by 15° about z.
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Dir.hxx>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::models {

struct WrenchSpec {
    double size = 0.0;        // across flats of the nut
    double jaw = 0.0;         // opening of the jaw
    double head_angle = 0.0;  // rad
    double head_width = 0.0;
    double head_thickness = 0.0;
    double handle_thickness = 0.0;
    double handle_width = 0.0;  // at the narrowest point
    double end = 0.0;           // x of the far end
};

// `grip`: from the middle of the jaw to the middle of the grip.
WrenchSpec wrench_spec(double size, double grip);

// One closed, valid solid.
Result<TopoDS_Shape> open_end_wrench(const WrenchSpec& spec);

// The parts of a wrench's head, for other wrenches with the same head:

// A disc that is cut off at the tips of the jaw. It is twice as tall as the finished head, so that head and
// handle can be cut to thickness together. The mouth points along −X; the head's angle is not applied yet.
TopoDS_Shape forged_head(const WrenchSpec& spec);

// Mills the jaw into a body whose head is already turned by the head's angle.
TopoDS_Shape with_jaw(const TopoDS_Shape& body, const WrenchSpec& spec);

// Strokes to cut out of both faces of the head, so that the size is stamped there.
std::vector<TopoDS_Shape> size_stamps(const WrenchSpec& spec);

// An edge direction along Z.
inline bool upright(const gp_Dir& along) { return along.Z() > 0.99 || along.Z() < -0.99; }

}  // namespace bolt::models
