// The whole file, read through a Reader that has checked it against the schema.
#pragma once

#include <string_view>

#include "content/format/assembly.hpp"
#include "content/format/reader.hpp"

namespace bolt::content {

// All variants are checked; the one that is asked for is given (empty: the file's default).
Assembly read_assembly(Reader& reader, std::string_view variant);

// The parts of it that stand in files of their own.
std::vector<AssemblyJoint> read_joints(Reader& reader, const std::string& variant);
// The least share of the target torque that a pass tightens to; 1 if that is not known.
double least_share(Reader& reader);
std::vector<Pass> read_passes(Reader& reader, const std::vector<AssemblyJoint>& joints);
joint::PublishedParameters read_published(Reader& reader);

}  // namespace bolt::content
