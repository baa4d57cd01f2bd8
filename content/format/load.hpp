// Reads an assembly file. Every mistake of the file is reported in one run, in the order of the file.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/error.hpp"
#include "engine/base/result.hpp"

namespace bolt::content {

// Either an assembly and no errors, or errors. Each error has ErrorCode::bad_content, file, line, column,
// pointer.
struct Loaded {
    Assembly assembly;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is for messages, and what the text names is taken from its folder; no file is looked for. `variant`:
// which of the file's "variants" to apply; empty: the file's default.
Loaded parse_assembly(std::string_view text, std::string_view file, std::string_view variant = {});

// `where` is a folder with an assembly.json, a file, or a name under content/assemblies. The files that it
// names have to be there, within content/ or, for an assembly that lies elsewhere, within its own folder.
Loaded load_assembly(const std::filesystem::path& where, std::string_view variant = {});

// Takes another of the assembly's tools into the hand; empty: the usual one. An error: there is none of this
// name.
Status choose_tool(Assembly& assembly, std::string_view name);

// Folder that holds content/ (schema/, assemblies/): $BOLTWRIGHT_CONTENT, else beside the program or above it
// (build tree), else the source tree that it was built from. Empty if none is there.
std::filesystem::path content_folder();

}  // namespace bolt::content
