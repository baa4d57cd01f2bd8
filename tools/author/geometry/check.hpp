// Checks that an assembly file agrees with its models and that the wrench can do the work: nodes, sizes,
// overlaps, room for the wrench, levels of detail.
#pragma once

#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"

namespace bolt::geometry {

struct Findings {
    std::vector<Error> errors;  // all bad_content, in the order of the file
    std::vector<Error> notes;   // not errors, but useful to the author
};

// `assembly` must have loaded without errors, and its model files must exist. An assembly without a model has
// no findings.
Findings check_geometry(const content::Assembly& assembly);

}  // namespace bolt::geometry
