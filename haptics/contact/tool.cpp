#include "haptics/contact/tool.hpp"

#include <fmt/format.h>

namespace bolt::contact {

Result<ToolShape> make_tool(std::span<const ContactMesh> parts, const ToolOptions& options) {
    if (!(options.samples.longest_piece > 0.0) || options.samples.on_faces > 1'000'000)
        return fail(ErrorCode::bad_content,
                    "a tool's edge pieces need a length, and a million points on its faces are enough");
    for (const ContactMesh& part : parts)
        if (part.open_edges > 0)
            return fail(ErrorCode::bad_content,
                        fmt::format("the tool's contact mesh is open along {} edges", part.open_edges),
                        "a closed surface");
    Result<Solid> solid = make_solid(parts);
    if (!solid) return fail(solid.error());
    ToolShape tool{std::move(*solid), {}, {}};
    tool.vicinity = make_vicinity(tool.solid, options.cell);
    tool.samples = make_samples(tool.solid, options.samples);
    return tool;
}

}  // namespace bolt::contact
