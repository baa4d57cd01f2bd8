// The whole file, read through a Reader that has checked it against the schema.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "content/format/assembly.hpp"
#include "content/format/reader.hpp"

namespace bolt::content {

// Where the files are that an assembly names.
struct FilePlaces {
    std::filesystem::path folder;  // of the assembly; what it names is found from here
    std::filesystem::path tools;   // folder of the tools' models
    std::filesystem::path root;    // nothing outside of it may be named; empty: the files are not looked for
};

// All variants are checked; the one that is asked for is given (empty: the file's default).
Assembly read_assembly(Reader& reader, std::string_view variant, const FilePlaces& places = {});

// The parts of it that stand in files of their own.
std::vector<AssemblyJoint> read_joints(Reader& reader, const std::string& variant);
// The least share of the target torque that a pass tightens to; 1 if that is not known.
double least_share(Reader& reader);
std::vector<Pass> read_passes(Reader& reader, const std::vector<AssemblyJoint>& joints);
joint::PublishedParameters read_published(Reader& reader);
// None: the file gives none.
std::optional<PublishedTargets> read_published_targets(Reader& reader, const joint::PublishedParameters& law);
ModelFiles read_model_files(Reader& reader, const FilePlaces& places);
std::string read_tool_model(Reader& reader, const Node& tool, const FilePlaces& places);

}  // namespace bolt::content
