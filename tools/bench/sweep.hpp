// What contact is measured with: a casing of as many triangles as wanted, the shipped wrench, and a way of
// the wrench near and into the casing.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/pose.hpp"
#include "engine/base/result.hpp"
#include "haptics/collision/world.hpp"

namespace bolt::bench {

// The meshes of a glTF file where their nodes are, one a node; of those nodes only whose name begins with one
// of `prefixes`, if there are any.
Result<std::vector<collision::ContactMesh>> load_contact(const std::filesystem::path& path,
                                                         const std::vector<std::string>& prefixes = {});

// Every edge longer than `longest` halved until there is none; new vertices lie on waves of 20 µm, so that
// nothing stays flat.
collision::ContactMesh refined(const collision::ContactMesh& mesh, double longest);

// A pose a millisecond: the tool comes to a place on the casing with a point of its own, goes 4 mm before it
// to 8 mm behind it, moves on along it, and goes on to the next, turned anyhow; minimum jerk, no point of it
// faster than 0.3 m/s. Where that leads into the casing it is pushed out again but for `deepest`, as a
// god-object would.
std::vector<Pose> make_sweep(const collision::World& world, const collision::Solid& casing,
                             const collision::ToolShape& tool, double deepest, double seconds);

}  // namespace bolt::bench
