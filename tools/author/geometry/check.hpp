// Whether what an assembly file says and what its models show agree, and whether the work can be done: nodes,
// sizes, room for the wrench, overlaps, levels of detail.
#pragma once

#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"

namespace bolt::geometry {

struct Findings {
    std::vector<Error> errors;  // all bad_content, in the order of the file
    std::vector<Error> notes;   // what is no mistake, but good to know
};

// `assembly` is one that loaded without a mistake, with its files. An assembly without a model has no
// findings.
Findings check_geometry(const content::Assembly& assembly);

}  // namespace bolt::geometry
