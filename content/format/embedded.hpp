// Files of content/ that the programs carry with them, as they were when the program was built.
#pragma once

#include <string_view>

namespace bolt::content {

std::string_view schema_text();    // schema/assembly.schema.json
std::string_view template_text();  // assemblies/cover-m8/assembly.json, the shape of a new assembly
std::string_view template_name();  // cover-m8

}  // namespace bolt::content
