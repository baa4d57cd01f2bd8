// What of a joint's nut each of an assembly's named views shows: for who chooses a view, and for authors who
// set them.
#pragma once

#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "haptics/contact/visibility.hpp"
#include "haptics/servo/touch.hpp"

namespace bolt::play {

struct NutView {
    double share = 0.0;  // 0…1 of the nut that stands free to the eye
    double size = 0.0;   // of what is seen, against a square that fills the picture's height
    bool framed = true;  // the nut's middle is in the picture, of four by three or wider
};

// Nuts go down to where they sit, as models show them and as they are when they are looked for last.
void seat_nuts(const servo::Setup& setup, servo::Touch& touch);

// In the order of the assembly's views, with everything where it is now. An empty answer: the joint's nut has
// no contact model.
std::vector<NutView> views_of_nut(const content::Assembly& assembly, const servo::Touch& touch,
                                  std::size_t joint);

// The one that shows most of the nut; none if it is seen from nowhere.
std::optional<std::size_t> best_view(std::span<const NutView> views);

}  // namespace bolt::play
