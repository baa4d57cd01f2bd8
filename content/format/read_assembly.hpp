// Converts an assembly file to an Assembly. The reader has checked the file against the schema.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/format/reader.hpp"

namespace bolt::content {

// Folders of the model files that an assembly refers to.
struct ModelFolders {
    std::filesystem::path folder;  // of the assembly; its paths are relative to this folder
    std::filesystem::path tools;   // of the tools' models
    std::filesystem::path root;    // files outside it are rejected; empty: files are not checked
};

// Checks all variants and returns the requested one (empty: the file's default).
Assembly read_assembly(JsonReader& reader, std::string_view variant, const ModelFolders& folders = {});

// All joints of the file with the changes of the variant. The changes to a joint type apply only if the
// variant works on a joint of this type.
std::vector<AssemblyJoint> read_joints(JsonReader& reader, const std::string& variant);

// The joints that a variant works on.
struct VariantJoints {
    std::vector<AssemblyJoint> all;     // of the file
    std::vector<AssemblyJoint> joints;  // of the variant, in the file's order
    bool named_by_variant = false;      // the variant names its joints; else it works on all
    std::vector<std::size_t> order;     // if so: indices in `joints`, in the variant's order
};
VariantJoints read_variant_joints(JsonReader& reader, const std::string& variant);
// The list "joints" of a variant; missing if it has none.
JsonNode variant_joint_list(JsonReader& reader, const std::string& variant);

// The smallest fraction of the target torque that a pass tightens to; 1 if unknown.
double smallest_pass_fraction(JsonReader& reader, const std::string& variant);

struct AssemblyPasses {
    std::vector<Pass> tightening, loosening;
};
// The parts of an assembly that its passes refer to.
struct PassReferences {
    const VariantJoints& joints;
    const std::vector<NamedView>& views;
    const std::string& variant;
    const ModelFolders& folders;
};
AssemblyPasses read_passes(JsonReader& reader, const PassReferences& context);
// The member "instruction" of a pass.
Instruction read_instruction(JsonReader& reader, const JsonNode& pass, const PassReferences& context);
// The models that an object names: the file, or what a variant adds.
ModelFiles read_model_files(JsonReader& reader, const JsonNode& object, const ModelFolders& folders);
// The models that a variant adds. Reports a kind of model that only the file or only the variant has.
ModelFiles read_added_models(JsonReader& reader, const std::string& variant, const ModelFolders& folders);
// Texts by language: the members of an object.
std::map<std::string, std::string> read_texts(JsonReader& reader, const JsonNode& object);
// The default tool, then the alternatives. A variant that names its joints has only the tools that turn them.
std::vector<Tool> read_tools(JsonReader& reader, const std::string& variant, const VariantJoints& joints,
                             const ModelFolders& folders);
// The path of a tool's model, the member "model"; empty if there is none.
std::string read_tool_model(JsonReader& reader, const JsonNode& tool, const ModelFolders& folders);

}  // namespace bolt::content
