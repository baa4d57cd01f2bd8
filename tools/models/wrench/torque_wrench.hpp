// A click torque wrench with an open-end insert, 40 to 200 N·m. Proportions are plausible, from no standard.
// Frame as for the other wrenches; the jaw of an insert is not turned: its mouth opens at −X.
#pragma once

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

namespace bolt::models {

Status add_torque_wrench(Document& document, double size);

}  // namespace bolt::models
