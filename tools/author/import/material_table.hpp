// content/materials.json: named PBR materials, and the colours and names by which a CAD file means them.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/error.hpp"
#include "tools/author/import/colour.hpp"

namespace bolt::step_import {

struct TableMaterial {
    std::string name;
    std::vector<std::string> colours;   // "#2F5D62", capitals
    std::vector<std::string> patterns;  // "*gasket*", for names of materials, faces and parts
    std::string member;                 // what a clamped part of it is made of: "cast_iron"; empty: unknown
    bool tint = false;  // a paint or a dye: the file's own colour takes the place of base_color
    assets::Material look;
};

struct MaterialTable {
    std::vector<TableMaterial> materials;  // by name
};

// Appends to `errors` everything that is wrong, with line and column. Materials of the text replace those of
// the table that have their name. `keys`: every key that was asked for.
void read_materials(std::string_view text, std::string_view file, MaterialTable& table,
                    std::vector<Error>& errors, std::set<std::string>* keys = nullptr);

// content/materials.json where the program finds its content, else as it was built in; over it, if it is
// there, materials.json in `folder`.
MaterialTable load_materials(const std::filesystem::path& folder, std::vector<Error>& errors);

}  // namespace bolt::step_import
