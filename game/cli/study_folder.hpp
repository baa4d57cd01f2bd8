// Shared by the commands of boltwright study.
#pragma once

#include <filesystem>

#include "content/studies/study.hpp"
#include "engine/base/result.hpp"

namespace CLI {
class App;
}

namespace bolt::cli {

// Loads a study. If its files have several mistakes, prints all but the last one and returns that one.
Result<content::Study> load_study_folder(const std::filesystem::path& folder);

// Adds the subcommand `run` to `study` (study_run.cpp).
void add_study_run(CLI::App& study, int& exit_code);

}  // namespace bolt::cli
