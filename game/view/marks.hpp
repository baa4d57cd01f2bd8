// What a picture points at: outlines, ghosts, and a part that is seen through whatever hides it.
#pragma once

#include "game/view/stage.hpp"

namespace bolt::view {

// Names of nodes; what hangs below them is meant too.
struct Marks {
    std::vector<std::string> outlined, ghosts;
    std::string seen;  // empty: nothing is cut away
};

// A line of that colour around the node and what hangs below it.
Status outline(Stage& stage, const Subject& subject, const std::string& node, const glm::vec4& color);

// Around the node and what hangs below it; empty where nothing of it is drawn.
Result<render::BoundingBox> box_of(const Stage& stage, const Subject& subject, const std::string& node);

// An error names the node that is nearest to one that is not there.
Status mark(Stage& stage, const Subject& subject, const Marks& marks);

}  // namespace bolt::view
