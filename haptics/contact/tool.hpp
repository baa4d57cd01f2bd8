// The tool as contact sees it: a solid in the tool's own frame, and where its surface touches first.
#pragma once

#include "haptics/contact/samples.hpp"
#include "haptics/contact/vicinity.hpp"

namespace bolt::contact {

struct ToolOptions {
    SampleOptions samples{.on_faces = 500};
    double cell = 0.75e-3;  // m, of its vicinity; 0: none
};

struct ToolShape {
    Solid solid;
    Vicinity vicinity;
    Samples samples;
    [[nodiscard]] double reach() const { return solid.reach; }  // m, of its furthest point from its origin
};

// `parts` lie in the tool's frame. An error: a part that is not watertight, for whether something is in the
// tool must be known.
Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options = {});

}  // namespace bolt::contact
