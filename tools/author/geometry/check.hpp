// Checks that an assembly file agrees with its models and that the tools can do the work: nodes, sizes,
// overlaps, kind, strength and room of the tools, levels of detail.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "tools/author/geometry/drawn_tool_room.hpp"

namespace bolt::geometry {

struct Findings {
    std::vector<Error> errors;  // all bad_content, in the order of the file
    std::vector<Error> notes;   // not errors, but useful to the author
};

// The progress of a check that runs on another thread, and the request to stop it.
struct CheckProgress {
    std::atomic<std::size_t> joints{0}, checked{0};  // 0 joints: the models are being read
    // Stops the check before the next joint; its findings are then incomplete.
    std::atomic<bool> stop{false};
};

// `assembly` must have loaded without errors, and its model files must exist. Without a model only kind, size
// and strength of the tools are checked. `rooms`: receives the room for the tool of each joint, if there is a
// model. `progress`: may be null.
Findings check_geometry(const content::Assembly& assembly, std::optional<DrawnToolRooms>* rooms = nullptr,
                        CheckProgress* progress = nullptr);

// Checks only kind, size and strength of the tools: for a variant whose joints and tools are those of another
// one that check_geometry has checked, and whose torques may differ.
Findings check_tool_choice(const content::Assembly& assembly);

// Checks references of the file that the reader of assembly.json does not check: the pictures of all
// instructions, also those of the variants, can be shown. Notes joint types that no joint has. Implemented in
// check_references.cpp.
Findings check_references(const content::Assembly& assembly);

}  // namespace bolt::geometry
