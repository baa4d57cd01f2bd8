// Projection walls for `train` and `displays test`: opens the walls of this process, which runs alone or in a
// cluster.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "game/view/walls.hpp"
#include "game/view/window.hpp"

namespace bolt::cli {

// The walls of this process.
struct OpenedWalls {
    std::unique_ptr<cluster::Cluster> cluster;  // null: this process shows all walls
    std::unique_ptr<view::Walls> walls;
    std::optional<view::WallFollower> follower;  // set if another process runs the lesson
};

// Opens the walls in a display file. Under mpirun, waits until all processes have opened their walls. Unless
// `quiet`, prints doubtful findings, and later a line whenever the tracker finds or loses the head. Fails if
// the file has mistakes or does not fit the monitors and processes, or if the tracker cannot be used.
Result<OpenedWalls> open_walls(const std::string& file, const platform::Desktop& desktop, bool quiet);

struct FollowOptions {
    std::string gpu;        // part of the name of the GPU to use; empty: the best
    bool validate = false;  // under Vulkan's validation layers; a message is an error
};

// Shows `content` on the walls of a process that follows the first process, until the first process ends.
Status follow_first_process(view::WindowContent& content, OpenedWalls& opened,
                            const platform::Desktop& desktop, const FollowOptions& options);

}  // namespace bolt::cli
