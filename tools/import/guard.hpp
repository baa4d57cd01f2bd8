// OpenCASCADE reads through null pointers in some damaged files, and others without end. The work is done in
// a process of its own, so that the author is told so instead of losing the program.
#pragma once

#include <filesystem>
#include <functional>

namespace bolt::step_import {

// Seconds of the processor that reading and meshing a file of this size never takes.
unsigned patience_for(const std::filesystem::path& step);

// The exit code of `work`; 3 with a message about `step` where it crashed or took `patience` seconds of the
// processor.
int run_guarded(const std::filesystem::path& step, const std::function<int()>& work, unsigned patience);
inline int run_guarded(const std::filesystem::path& step, const std::function<int()>& work) {
    return run_guarded(step, work, patience_for(step));
}

}  // namespace bolt::step_import
