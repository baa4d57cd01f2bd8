// OpenCASCADE reads through null pointers in some damaged files. The work is done in a process of its own, so
// that the author is told so instead of losing the program.
#pragma once

#include <filesystem>
#include <functional>

namespace bolt::step_import {

// The exit code of `work`; 3 with a message about `step` where it crashed.
int run_guarded(const std::filesystem::path& step, const std::function<int()>& work);

}  // namespace bolt::step_import
