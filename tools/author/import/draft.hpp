// A first assembly.json from what the geometry shows. What a STEP file cannot tell is a stated default.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/author/import/joints.hpp"

namespace bolt::step_import {

struct DraftInput {
    std::string title;
    std::string source;               // name of the STEP file
    std::string model, far, contact;  // file names; empty: there is none
    std::string schema;               // what "$schema" says
    Vec3 low{0.0}, high{0.0};         // of the whole assembly, m
    const JointSearch* search = nullptr;
    std::vector<std::string> member_of;  // material of clamped parts, by tree node; empty: unknown
    std::vector<bool> stainless;         // by tree node: for bolts
};

struct Draft {
    std::string text;  // empty: there is no joint to write
    std::size_t joints = 0;
    std::vector<std::string> remarks;
};

Draft make_draft(const DraftInput& input);

}  // namespace bolt::step_import
