// The Khronos glTF validator, run as the program that it is (tools/install-node-tools.sh installs it).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/error.hpp"
#include "engine/base/result.hpp"

namespace bolt::author {

// The script that runs it; empty if it is not installed. $BOLTWRIGHT_GLTF_VALIDATOR names its folder,
// otherwise it is tools/gltf-validator beside content/.
std::filesystem::path gltf_validator();

// What it says of the files, warnings too: each an error with file and JSON pointer.
Result<std::vector<Error>> run_gltf_validator(const std::filesystem::path& script,
                                              const std::vector<std::string>& files);

}  // namespace bolt::author
