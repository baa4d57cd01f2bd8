// The two-stage helical gear reducer ZQ350 with its twelve joints, as a CAD document.
#pragma once

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

namespace bolt::models {

Status add_zq350(Document& document);

}  // namespace bolt::models
