// CAD colours, the table of PBR materials (content/materials.json) and the choice of a material for each
// face.
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

// sRGB, 0 … 1.
struct Colour {
    double r = 0.0, g = 0.0, b = 0.0, alpha = 1.0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

// Conversion to and from "#2F5D62", without alpha.
std::string hex(const Colour& colour);
std::optional<Colour> parse_hex(std::string_view text);

// Linear RGB by IEC 61966-2-1.
glm::vec3 linear(const Colour& colour);

// (Largest − smallest component) / largest; 0 for grey.
double saturation(const Colour& colour);

// One entry of content/materials.json: a PBR material, and the colours and names that select it.
struct TableMaterial {
    std::string name;
    std::vector<std::string> colours;   // "#2F5D62", upper case
    std::vector<std::string> patterns;  // "*gasket*", for names of materials, faces and parts
    std::string member_material;        // material of a clamped part: "cast_iron"; empty: unknown
    bool tint = false;                  // paint or dye: the colour of the CAD file replaces base_color
    assets::Material pbr;
};

struct MaterialTable {
    std::vector<TableMaterial> materials;  // sorted by name
};

// Reads the materials of `text` into the table; each replaces a material of the same name. Appends all errors
// with line and column. `keys` receives every key that the reader knows.
void read_materials(std::string_view text, std::string_view file, MaterialTable& table,
                    std::vector<Error>& errors, std::set<std::string>* keys = nullptr);

// The text of content/materials.json at build time.
std::string_view materials_text();

// Loads materials.json from the content folder, or the built-in copy if there is none, then materials.json
// from `folder` if it exists.
MaterialTable load_materials(const std::filesystem::path& folder, std::vector<Error>& errors);

// The properties of a face in the CAD file that select its material.
struct FaceAppearance {
    std::optional<Colour> colour;
    std::string material;  // from the list of materials in the CAD file: "C45"
    std::string face_name, part_name;
};

// Chooses a material for each face and collects the chosen ones.
class MaterialPicker {
  public:
    explicit MaterialPicker(const MaterialTable& table) : table_(table) {}

    // Returns an index into materials(). Order: an exact colour of the table; a name, longest pattern first;
    // a guess from the colour, with transparent as glass, grey or none as metal, nearly black as plastic and
    // all else as paint.
    int pick(const FaceAppearance& appearance);

    [[nodiscard]] const std::vector<assets::Material>& materials() const { return materials_; }
    // Material of a clamped part with the material `index` of materials(); empty: unknown.
    [[nodiscard]] const std::string& member_material(int index) const {
        return member_materials_[static_cast<std::size_t>(index)];
    }
    // The reason for each guessed material, by its name.
    [[nodiscard]] const std::map<std::string, std::string>& guesses() const { return guesses_; }

  private:
    const MaterialTable& table_;
    std::vector<assets::Material> materials_;
    std::vector<std::string> member_materials_;
    std::map<std::string, int> index_;
    std::map<std::string, std::string> guesses_;

    int add(assets::Material material, std::string member_material);
    const TableMaterial* by_colour(const Colour& colour) const;
    const TableMaterial* by_name(const FaceAppearance& appearance) const;
    int tinted(const TableMaterial& material, const Colour& colour);
    int guess(const std::optional<Colour>& colour);
};

}  // namespace bolt::step_import
