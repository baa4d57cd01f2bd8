// Files of content/ that are embedded in the programs at build time.
#pragma once

#include <string_view>

namespace bolt::content {

std::string_view assembly_schema_text();       // schema/assembly.schema.json
std::string_view displays_schema_text();       // schema/displays.schema.json
std::string_view questionnaire_schema_text();  // schema/questionnaire.schema.json
std::string_view study_schema_text();          // schema/study.schema.json
std::string_view rig_schema_text();            // schema/rig.schema.json
std::string_view template_text();  // assemblies/cover-m8/assembly.json, the template of a new assembly
std::string_view template_name();  // cover-m8

}  // namespace bolt::content
