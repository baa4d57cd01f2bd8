// The parts of generated tools as closed shells, in the frame of parameters.hpp. Millimetres and radians.
// Shells of one part may overlap. Each builder makes a fine shape for pictures or a coarse one for contact.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "game/tool_models/parameters.hpp"
#include "game/tool_models/shell.hpp"

namespace bolt::tool_models {

// Appearances of content/materials.json, and the screen and the lights of an electronic torque wrench.
enum class Finish : std::uint8_t { chrome_vanadium, black_oxide, rubber, signal_red, screen, light, alarm };

enum class Detail : std::uint8_t { drawn, contact };

struct ToolModelPart {
    std::string name;
    Finish finish = Finish::chrome_vanadium;
    std::vector<Shell> shells;
};
using ToolModelParts = std::vector<ToolModelPart>;

// Dimensions of an open-end head; the proportions are those of tools/assets/models/wrench.cpp. The slot's
// axis points to its throat.
struct OpenEndHead {
    double size = 0.0, opening = 0.0, angle = 0.0, thickness = 0.0, depth = 0.0, tip = 0.0;
    // `angle`: from the handle to the slot's axis. `depth`, `tip`: from the middle of the jaw to its throat
    // and to its tips.
    double radius = 0.0, middle = 0.0;  // of the disc, whose middle is at `middle` on the slot's axis

    // The largest x of the slot: a handle starts beyond it.
    [[nodiscard]] double slot_end() const;
};
OpenEndHead open_end_head(const ToolParameters& p);
Shell open_end_shell(const OpenEndHead& head, double edge, Detail detail);  // `edge`: radius of the edges

// A handle in the plane y = 0 as a row of cross-sections with rounded edges.
struct HandleSection {
    double x = 0.0, z = 0.0;  // middle of the section
    double slope = 0.0;       // rad, of the handle above +X
    double half_width = 0.0, half_height = 0.0;
    double edge = 0.0;       // radius of the edges
    double end_angle = 0.0;  // direction of a round end's outline: 0 at its side, pi/2 at its tip
    // The hollows in the upper and the lower face.
    double hollow_half_width = 0.0, hollow_depth = 0.0;
};
Shell handle_shell(const std::vector<HandleSection>& sections, Detail detail);

// Appends the sections of a round end: half a disc with the half width of `last`.
void add_round_end(std::vector<HandleSection>& sections, const HandleSection& last, int steps);

struct RingHead {
    // `opening`: across flats. `outside`: diameter. `thickness`: along the bolt.
    double opening = 0.0, outside = 0.0, thickness = 0.0;
};
RingHead ring_head(const ToolParameters& p);
Shell ring_shell(const RingHead& ring, Detail detail);

ToolModelParts open_end_parts(const ToolParameters& p, Detail detail);
ToolModelParts ring_parts(const ToolParameters& p, Detail detail);
ToolModelParts combination_parts(const ToolParameters& p, Detail detail);
ToolModelParts hex_key_parts(const ToolParameters& p, Detail detail);
ToolModelParts ratchet_parts(const ToolParameters& p, Detail detail);
ToolModelParts extension_bar_parts(const ToolParameters& p, Detail detail);
ToolModelParts adaptor_parts(const ToolParameters& p, Detail detail);
ToolModelParts hex_bit_parts(const ToolParameters& p, Detail detail);
ToolModelParts torque_wrench_parts(const ToolParameters& p, Detail detail);

// The gripping part of a socket, mm. `low`, `shoulder`: z of the lower end and of the upper end of the flats.
// `lead`: leg of the chamfer at the mouth. `outside`: diameter.
struct SocketGrip {
    double low = 0.0, shoulder = 0.0, lead = 0.0, outside = 0.0;
};
SocketGrip socket_grip(const ToolParameters& p);

// The gripping part of a key or a bit, mm. `tip`: z of its end. `chamfer`: at that end. `length`: of the
// straight hexagon.
struct KeyGrip {
    double tip = 0.0, chamfer = 0.0, length = 0.0;
};
KeyGrip key_grip(const ToolParameters& p);

// A ratchet head with its socket or bit, for a torque wrench. `radius`, `middle` (its z) and `high` (its
// height) are those of the ratchet head, mm.
struct RatchetWithAttachment {
    ToolModelParts parts;
    double radius = 0.0, middle = 0.0, high = 0.0;
};
RatchetWithAttachment ratchet_with_attachment(const ToolParameters& p, Detail detail);

ToolModelParts parts_of(const ToolParameters& completed, Detail detail);

// A size as it is written on a tool: "24", "12.5".
std::string size_text(double size_mm);

// Adds a text as raised strokes to the part "size", which is made if it is not the last part. The text is
// read along +X; its middle is at `x`, on a level face at the height `z`. A contact model gets no text.
void add_text(ToolModelParts& parts, std::string_view text, double height, double x, double z, Detail detail);

}  // namespace bolt::tool_models
