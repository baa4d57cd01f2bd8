// Where the content and the assemblies of the user are.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

// The content folder (with schema/ and assemblies/): $BOLTWRIGHT_CONTENT; else content/ or
// share/boltwright/content/ in the program's folder or a folder above it; else boltwright/content/ in a
// folder of $XDG_DATA_DIRS; else that of the source tree from which the program was built, if it was not
// built for a package. Empty if none exists, or if $BOLTWRIGHT_CONTENT is not a content folder.
std::filesystem::path content_folder();

// The folders whose subfolders are assemblies: assemblies/ in user_data_folder(), then in content_folder().
// An assembly in the first hides one of the same name in the second. The folders need not exist.
std::vector<std::filesystem::path> assembly_folders();

// The names of all assemblies in these folders, sorted. An assembly is a folder with an assembly.json.
std::vector<std::string> assembly_names();

// The folder of the assembly with this name in assembly_folders(); `name` itself if there is none.
std::filesystem::path assembly_folder(const std::string& name);

}  // namespace bolt::content
