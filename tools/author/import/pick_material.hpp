// Which material a face gets, and why: an exact colour of the table, a name, or a plausible guess from the
// colour.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/assets/model.hpp"
#include "tools/author/import/material_table.hpp"

namespace bolt::step_import {

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
