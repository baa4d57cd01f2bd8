// Checks that an assembly file agrees with its models and that the wrench can do the work: nodes, sizes,
// overlaps, room for the wrench, levels of detail.
#pragma once

#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "tools/author/geometry/wrench_room.hpp"

namespace bolt::geometry {

struct Findings {
    std::vector<Error> errors;  // all bad_content, in the order of the file
    std::vector<Error> notes;   // not errors, but useful to the author
};

// `assembly` must have loaded without errors, and its model files must exist. An assembly without a model has
// no findings. `rooms`: receives the room for the default wrench on each joint, if there is a model.
Findings check_geometry(const content::Assembly& assembly, std::optional<WrenchRooms>* rooms = nullptr);

}  // namespace bolt::geometry
