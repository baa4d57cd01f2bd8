// content/materials.json as it was when the program was built.
#pragma once

#include <string_view>

namespace bolt::step_import {

std::string_view materials_text();

}  // namespace bolt::step_import
