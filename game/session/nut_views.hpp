// How much of a joint's nut each named view of an assembly shows, for choosing a view and for authors who
// define them.
#pragma once

#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "haptics/collision/world.hpp"
#include "haptics/servo/tool_contact.hpp"

namespace bolt::session {

struct NutView {
    double share = 0.0;  // visible fraction of the nut, 0…1
    double size = 0.0;   // visible area, relative to a square of the picture's height
    bool framed = true;  // the nut's centre is inside a picture of 4:3 or wider
};

// Moves all nuts down to their seats, as the models show them.
void seat_nuts(const servo::Setup& setup, servo::ToolContact& touch);

// One entry for each view of the assembly, in its order, with all bodies where they are now. Empty if the
// joint's nut has no contact model.
std::vector<NutView> views_of_nut(const content::Assembly& assembly, const servo::ToolContact& touch,
                                  std::size_t joint);

// Index of the view that shows most of the nut; none if no view shows it.
std::optional<std::size_t> best_view(std::span<const NutView> views);

}  // namespace bolt::session
