// Drafts assembly.json from the geometry. Values that a STEP file does not contain are defaults, which the
// draft states.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/author/import/joints.hpp"

namespace bolt::step_import {

struct DraftInput {
    std::string title;
    std::string source;               // name of the STEP file
    std::string model, far, contact;  // file names; empty: no such file
    std::string schema;               // value of "$schema"
    Vec3 low{0.0}, high{0.0};         // of the whole assembly, m
    const JointSearchResult* search = nullptr;
    std::vector<std::string> member_materials;  // material of clamped parts, by tree node; empty: unknown
    std::vector<bool> stainless;                // by tree node: the part is of stainless steel
};

struct Draft {
    std::string text;  // of assembly.json; empty without a joint
    std::size_t joints = 0;
    std::vector<std::string> tools, joint_types;  // in words, with the assumptions
    std::vector<std::string> remarks;
};

Draft make_draft(const DraftInput& input);

}  // namespace bolt::step_import
