// A joint's torque–angle curve as a drawing: stages shaded, target window, clamp force beside it.
#pragma once

#include <span>
#include <string>

#include "content/format/assembly.hpp"
#include "haptics/joint/group.hpp"

namespace bolt::author {

// A whole SVG file. Angles count from the first contact (tightening) or from where the run begins
// (loosening).
std::string curve_svg(const content::AssemblyJoint& joint, std::span<const joint::CurveSample> run,
                      joint::Direction direction, std::string_view title);

}  // namespace bolt::author
