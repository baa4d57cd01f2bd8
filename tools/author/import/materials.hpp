// A CAD colour: sRGB as the file and its author write it.
#pragma once

#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"

namespace bolt::step_import {

struct Colour {
    double r = 0.0, g = 0.0, b = 0.0, alpha = 1.0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

// "#2F5D62", and the other way. Alpha is not part of it.
std::string hex(const Colour& colour);
std::optional<Colour> parse_hex(std::string_view text);

// IEC 61966-2-1.
glm::vec3 linear(const Colour& colour);

// Largest less smallest component over the largest; 0: grey.
double saturation(const Colour& colour);

// content/materials.json: named PBR materials, and the colours and names by which a CAD file means them.

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

// Which material a face gets, and why: an exact colour of the table, a name, or a plausible guess from the
// colour.

// What the file says about a face.
struct Appearance {
    std::optional<Colour> colour;
    std::string material;  // of the CAD's own list: "C45"
    std::string face_name, part_name;
};

class MaterialPicker {
  public:
    explicit MaterialPicker(const MaterialTable& table) : table_(table) {}

    // Index into materials(). Colour first; then the names, longest pattern first; then a guess: a painted
    // surface keeps the file's colour, light grey is taken for steel, black for plastic, everything else for
    // paint.
    int pick(const Appearance& appearance);

    [[nodiscard]] const std::vector<assets::Material>& materials() const { return materials_; }
    // What a clamped part of this material is made of; empty: unknown.
    [[nodiscard]] const std::string& member(int index) const {
        return members_[static_cast<std::size_t>(index)];
    }
    // What had to be guessed, by the name of the material.
    [[nodiscard]] const std::map<std::string, std::string>& guesses() const { return guesses_; }

  private:
    const MaterialTable& table_;
    std::vector<assets::Material> materials_;
    std::vector<std::string> members_;
    std::map<std::string, int> index_;
    std::map<std::string, std::string> guesses_;

    int add(assets::Material material, std::string member);
    const TableMaterial* by_colour(const Colour& colour) const;
    const TableMaterial* by_name(const Appearance& appearance) const;
    int tinted(const TableMaterial& material, const Colour& colour);
    int guess(const std::optional<Colour>& colour);
};

}  // namespace bolt::step_import
