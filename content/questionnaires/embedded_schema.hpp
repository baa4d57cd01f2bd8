// schema/questionnaire.schema.json, embedded in the programs at build time.
#pragma once

#include <string_view>

namespace bolt::content {

std::string_view questionnaire_schema_text();

}  // namespace bolt::content
