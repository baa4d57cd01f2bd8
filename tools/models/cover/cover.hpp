// A small housing with a cover on four bolts M8: the template of a new assembly. All of it is made up.
#pragma once

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

namespace bolt::models {

// The cover's upper face, under the nuts, lies at CAD z = 10 mm; bolts at (±50, ±40).
Status add_cover_m8(Document& document);

}  // namespace bolt::models
