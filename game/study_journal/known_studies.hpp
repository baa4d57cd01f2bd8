// The folders of the studies that people take part in on this computer, so that everything about a person can
// be found without knowing where the studies are: DATA/studies.txt, one absolute path in a line.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::study {

inline constexpr const char* known_studies_file_name = "studies.txt";

// `data`: the user's data folder. Remembers a study's folder, once. Fails if that cannot be written, because
// an answer that erasure does not find must not be recorded.
Status remember_study(const std::filesystem::path& data, const std::filesystem::path& study_folder);

// In the order in which they were remembered. None without the file.
Result<std::vector<std::filesystem::path>> known_studies(const std::filesystem::path& data);

}  // namespace bolt::study
