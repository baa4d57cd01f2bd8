// The head of an open-end wrench: forged, with the jaw milled into it and the size stamped on it.
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Dir.hxx>
#include <vector>

#include "tools/models/wrench/wrench.hpp"

namespace bolt::models {

// A disc cut off at the tips of the jaws, as tall as twice the head is thick, to be cut to its thickness
// together with the handle. In the wrench's frame with the mouth along −X, not yet turned by the head's
// angle.
TopoDS_Shape forged_head(const WrenchSpec& spec);

// Mills the jaw into a body whose head is turned by the head's angle.
TopoDS_Shape with_jaw(const TopoDS_Shape& body, const WrenchSpec& spec);

// What to cut out of both faces of the head so that the size stands there.
std::vector<TopoDS_Shape> size_stamps(const WrenchSpec& spec);

inline bool upright(const gp_Dir& along) { return along.Z() > 0.99 || along.Z() < -0.99; }

}  // namespace bolt::models
