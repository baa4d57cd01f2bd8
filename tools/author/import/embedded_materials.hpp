// The text of content/materials.json at build time.
#pragma once

#include <string_view>

namespace bolt::step_import {

std::string_view materials_text();

}  // namespace bolt::step_import
