#include "tools/author/import/pick_material.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/author/import/names.hpp"

namespace bolt::step_import {

namespace {

// A colour goes through floats in CAD programs: one step of 255 is the same colour.
bool same_colour(const Colour& colour, const std::string& key) {
    const auto other = parse_hex(key);
    constexpr double step = 1.001 / 255.0;
    return other && std::abs(other->r - colour.r) < step && std::abs(other->g - colour.g) < step &&
           std::abs(other->b - colour.b) < step;
}

assets::Material plain(const Colour& colour, std::string name, float metallic, float roughness) {
    assets::Material material;
    material.name = std::move(name);
    material.base_color = {linear(colour), static_cast<float>(colour.alpha)};
    if (colour.alpha < 1.0) material.alpha_mode = assets::AlphaMode::blend;
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

}  // namespace

int MaterialPicker::add(assets::Material material, std::string member) {
    const auto [known, fresh] = index_.emplace(material.name, static_cast<int>(materials_.size()));
    if (fresh) {
        materials_.push_back(std::move(material));
        members_.push_back(std::move(member));
    }
    return known->second;
}

const TableMaterial* MaterialPicker::by_colour(const Colour& colour) const {
    const std::string exact = hex(colour);
    for (const TableMaterial& material : table_.materials)
        if (std::find(material.colours.begin(), material.colours.end(), exact) != material.colours.end())
            return &material;
    for (const TableMaterial& material : table_.materials)
        for (const std::string& key : material.colours)
            if (same_colour(colour, key)) return &material;
    return nullptr;
}

const TableMaterial* MaterialPicker::by_name(const Appearance& appearance) const {
    for (const std::string& name : {appearance.material, appearance.face_name, appearance.part_name}) {
        if (name.empty()) continue;
        const TableMaterial* best = nullptr;
        std::size_t longest = 0;
        for (const TableMaterial& material : table_.materials) {
            if (material.name == name) return &material;
            for (const std::string& pattern : material.patterns)
                if (pattern.size() > longest && matches(pattern, name)) {
                    longest = pattern.size();
                    best = &material;
                }
        }
        if (best != nullptr) return best;
    }
    return nullptr;
}

int MaterialPicker::tinted(const TableMaterial& material, const Colour& colour) {
    assets::Material look = material.look;
    look.name = fmt::format("{}_{}", material.name, hex(colour).substr(1));
    look.base_color = {linear(colour), static_cast<float>(colour.alpha)};
    if (colour.alpha < 1.0) look.alpha_mode = assets::AlphaMode::blend;
    return add(std::move(look), material.member);
}

int MaterialPicker::guess(const std::optional<Colour>& colour) {
    if (!colour) {
        guesses_.emplace("no_colour", "no colour in the file: taken for machined steel");
        return add(plain({0.77, 0.776, 0.784}, "no_colour", 1.0F, 0.4F), "steel");
    }
    const std::string key = hex(*colour).substr(1);
    const double value = std::max({colour->r, colour->g, colour->b});
    if (colour->alpha < 0.999) {
        const std::string name = fmt::format("glass_{}_{:02X}", key, std::lround(colour->alpha * 255.0));
        guesses_.emplace(name, "transparent: taken for glass");
        return add(plain(*colour, name, 0.0F, 0.05F), "");
    }
    if (saturation(*colour) < 0.12 && value >= 0.35 && value <= 0.93) {
        guesses_.emplace("metal_" + key, "grey: taken for a metal");
        return add(plain(*colour, "metal_" + key, 1.0F, 0.4F), "steel");
    }
    if (value < 0.25) {
        guesses_.emplace("plastic_" + key, "nearly black: taken for plastic");
        return add(plain(*colour, "plastic_" + key, 0.0F, 0.55F), "");
    }
    guesses_.emplace("paint_" + key, "taken for paint");
    assets::Material paint = plain(*colour, "paint_" + key, 0.0F, 0.5F);
    paint.clearcoat = 0.5F;
    paint.clearcoat_roughness = 0.2F;
    return add(std::move(paint), "");
}

int MaterialPicker::pick(const Appearance& appearance) {
    if (appearance.colour)
        if (const TableMaterial* found = by_colour(*appearance.colour))
            return add(found->look, found->member);
    if (const TableMaterial* found = by_name(appearance))
        return found->tint && appearance.colour ? tinted(*found, *appearance.colour)
                                                : add(found->look, found->member);
    return guess(appearance.colour);
}

}  // namespace bolt::step_import
