// schema/displays.schema.json, embedded in the programs at build time.
#pragma once

#include <string_view>

namespace bolt::content {

std::string_view displays_schema_text();

}  // namespace bolt::content
