#include "tools/author/import/materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/file.hpp"
#include "tools/author/import/names.hpp"

namespace bolt::step_import {

namespace {

int byte(double value) { return static_cast<int>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0)); }

float to_linear(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

}  // namespace

std::string hex(const Colour& colour) {
    return fmt::format("#{:02X}{:02X}{:02X}", byte(colour.r), byte(colour.g), byte(colour.b));
}

std::optional<Colour> parse_hex(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    const auto part = [value](unsigned shift) {
        return static_cast<double>((value >> shift) & 0xFFU) / 255.0;
    };
    return Colour{part(16), part(8), part(0)};
}

glm::vec3 linear(const Colour& colour) {
    return {to_linear(colour.r), to_linear(colour.g), to_linear(colour.b)};
}

double saturation(const Colour& colour) {
    const double most = std::max({colour.r, colour.g, colour.b});
    const double least = std::min({colour.r, colour.g, colour.b});
    return most > 0.0 ? (most - least) / most : 0.0;
}

namespace {

using content::JsonDocument;
using content::JsonPart;
using nlohmann::json;

// Reads the members of one JSON object by name. reject_unknown_keys() reports the members that were not read.
class MaterialObjectReader {
  public:
    MaterialObjectReader(const JsonDocument& document, const json& object, std::string pointer,
                         std::vector<Error>& errors, std::set<std::string>* keys)
        : document_(document), object_(object), pointer_(std::move(pointer)), errors_(errors), keys_(keys) {}

    const json* find(const char* key) {
        known_.emplace_back(key);
        if (keys_ != nullptr) keys_->insert(key);
        const auto found = object_.find(key);
        return found == object_.end() ? nullptr : &*found;
    }

    void number(const char* key, float& value, double least, double most) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_number() || found->get<double>() < least || found->get<double>() > most)
            return wrong(key, "is not a number in range", fmt::format("{:g} to {:g}", least, most));
        value = found->get<float>();
    }

    void flag(const char* key, bool& value) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_boolean()) return wrong(key, "is not a boolean", "true or false");
        value = found->get<bool>();
    }

    void text(const char* key, std::string& value) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_string()) return wrong(key, "is not a text", "a text in quotes");
        value = found->get<std::string>();
    }

    void texts(const char* key, std::vector<std::string>& values) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_array()) return wrong(key, "is not a list", "a list of texts");
        for (const json& item : *found) {
            if (!item.is_string()) return wrong(key, "has an element that is not a text", "a list of texts");
            values.push_back(item.get<std::string>());
        }
    }

    void colour(const char* key, glm::vec3& value) {
        std::string written;
        text(key, written);
        if (written.empty()) return;
        if (const auto parsed = parse_hex(written))
            value = linear(*parsed);
        else
            wrong(key, fmt::format("{} is not a colour", content::in_quotes(written)),
                  "sRGB as in \"#2F5D62\"");
    }

    void wrong(const std::string& key, std::string what, std::string expected) {
        errors_.push_back(document_.error(pointer_ + "/" + content::pointer_token(key), JsonPart::value,
                                          std::move(what), std::move(expected)));
    }

    void reject_unknown_keys() {
        for (const auto& [key, value] : object_.items())
            if (std::find(known_.begin(), known_.end(), key) == known_.end())
                errors_.push_back(document_.error(pointer_ + "/" + content::pointer_token(key), JsonPart::key,
                                                  fmt::format("unknown property {}", content::in_quotes(key)),
                                                  content::suggest(key, known_)));
    }

  private:
    const JsonDocument& document_;
    const json& object_;
    std::string pointer_;
    std::vector<Error>& errors_;
    std::set<std::string>* keys_;
    std::vector<std::string> known_;
};

void read_pbr(MaterialObjectReader& in, assets::Material& pbr) {
    glm::vec3 base{1.0F};
    in.colour("base_color", base);
    float alpha = 1.0F;
    in.number("alpha", alpha, 0.0, 1.0);
    pbr.base_color = {base, alpha};
    if (alpha < 1.0F) pbr.alpha_mode = assets::AlphaMode::blend;
    in.number("metallic", pbr.metallic, 0.0, 1.0);
    in.number("roughness", pbr.roughness, 0.0, 1.0);
    in.number("clearcoat", pbr.clearcoat, 0.0, 1.0);
    in.number("clearcoat_roughness", pbr.clearcoat_roughness, 0.0, 1.0);
    in.number("anisotropy", pbr.anisotropy, 0.0, 1.0);
    float degrees = 0.0F;
    in.number("anisotropy_rotation_deg", degrees, -360.0, 360.0);
    pbr.anisotropy_rotation = static_cast<float>(to_radians(static_cast<double>(degrees)));
    in.number("ior", pbr.ior, 1.0, 3.0);
    in.number("specular", pbr.specular, 0.0, 1.0);
    in.colour("specular_color", pbr.specular_color);
    in.flag("double_sided", pbr.double_sided);
}

TableMaterial read_material(MaterialObjectReader& in, const std::string& name) {
    TableMaterial material;
    material.name = material.pbr.name = name;
    material.pbr.metallic = 0.0F;
    material.pbr.roughness = 0.5F;
    std::string ignored;
    in.text("description", ignored);
    in.texts("colors", material.colours);
    for (std::string& colour : material.colours) {
        if (const auto parsed = parse_hex(colour))
            colour = hex(*parsed);
        else
            in.wrong("colors", fmt::format("{} is not a colour", content::in_quotes(colour)),
                     "sRGB as in \"#2F5D62\"");
    }
    in.texts("names", material.patterns);
    in.text("member", material.member_material);
    in.flag("tint", material.tint);
    read_pbr(in, material.pbr);
    in.reject_unknown_keys();
    return material;
}

void check_colours(const JsonDocument& document, const MaterialTable& table, std::vector<Error>& errors) {
    std::map<std::string, std::string> first;
    for (const TableMaterial& material : table.materials)
        for (const std::string& colour : material.colours) {
            const auto [known, fresh] = first.emplace(colour, material.name);
            if (fresh) continue;
            errors.push_back(document.error(
                "/materials/" + content::pointer_token(material.name), JsonPart::key,
                fmt::format("{} is already a colour of {}", colour, content::in_quotes(known->second)),
                "every colour once"));
        }
}

}  // namespace

void read_materials(std::string_view text, std::string_view file, MaterialTable& table,
                    std::vector<Error>& errors, std::set<std::string>* keys) {
    const std::size_t before = errors.size();
    const auto document = JsonDocument::parse(text, file, errors);
    if (!document) return;
    const json& root = document->root();
    if (!root.is_object() || !root.contains("materials") || !root["materials"].is_object()) {
        errors.push_back(document->error("", JsonPart::value, "the file has no object \"materials\"",
                                         "{ \"materials\": { \"my_paint\": { … } } }"));
        return;
    }
    MaterialObjectReader top(*document, root, "", errors, keys);
    (void)top.find("materials");
    std::string ignored;
    top.text("$schema", ignored);
    top.text("sources", ignored);
    top.reject_unknown_keys();
    for (const auto& [name, value] : root["materials"].items()) {
        const std::string pointer = "/materials/" + content::pointer_token(name);
        if (!value.is_object()) {
            errors.push_back(document->error(pointer, JsonPart::value, "is not an object",
                                             "an object: { \"base_color\": \"#C4C6C8\", … }"));
            continue;
        }
        MaterialObjectReader members(*document, value, pointer, errors, keys);
        TableMaterial material = read_material(members, name);
        const auto at =
            std::lower_bound(table.materials.begin(), table.materials.end(), name,
                             [](const TableMaterial& one, const std::string& key) { return one.name < key; });
        if (at != table.materials.end() && at->name == name)
            *at = std::move(material);
        else
            table.materials.insert(at, std::move(material));
    }
    if (errors.size() == before) check_colours(*document, table, errors);
}

MaterialTable load_materials(const std::filesystem::path& folder, std::vector<Error>& errors) {
    MaterialTable table;
    std::error_code ignored;
    const std::filesystem::path content = content::content_folder();
    const std::filesystem::path shipped = content / "materials.json";
    if (!content.empty() && std::filesystem::exists(shipped, ignored)) {
        if (const auto text = read_file(shipped, content::json_size_limit, ErrorCode::bad_content))
            read_materials(*text, shipped.string(), table, errors);
        else
            errors.push_back(text.error());
    } else {
        read_materials(materials_text(), "materials.json (built in)", table, errors);
    }
    const std::filesystem::path own = folder / "materials.json";
    if (std::filesystem::exists(own, ignored) && !std::filesystem::equivalent(own, shipped, ignored)) {
        if (const auto text = read_file(own, content::json_size_limit, ErrorCode::bad_content))
            read_materials(*text, own.string(), table, errors);
        else
            errors.push_back(text.error());
    }
    return table;
}

namespace {

// CAD programs store colours as floats, so a difference of one step of 255 is the same colour.
bool same_colour(const Colour& colour, const std::string& key) {
    const auto other = parse_hex(key);
    constexpr double step = 1.001 / 255.0;
    return other && std::abs(other->r - colour.r) < step && std::abs(other->g - colour.g) < step &&
           std::abs(other->b - colour.b) < step;
}

assets::Material make_material(const Colour& colour, std::string name, float metallic, float roughness) {
    assets::Material material;
    material.name = std::move(name);
    material.base_color = {linear(colour), static_cast<float>(colour.alpha)};
    if (colour.alpha < 1.0) material.alpha_mode = assets::AlphaMode::blend;
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

}  // namespace

int MaterialPicker::add(assets::Material material, std::string member_material) {
    const auto [known, fresh] = index_.emplace(material.name, static_cast<int>(materials_.size()));
    if (fresh) {
        materials_.push_back(std::move(material));
        member_materials_.push_back(std::move(member_material));
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

const TableMaterial* MaterialPicker::by_name(const FaceAppearance& appearance) const {
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
    assets::Material pbr = material.pbr;
    pbr.name = fmt::format("{}_{}", material.name, hex(colour).substr(1));
    pbr.base_color = {linear(colour), static_cast<float>(colour.alpha)};
    if (colour.alpha < 1.0) pbr.alpha_mode = assets::AlphaMode::blend;
    return add(std::move(pbr), material.member_material);
}

int MaterialPicker::guess(const std::optional<Colour>& colour) {
    if (!colour) {
        guesses_.emplace("no_colour", "no colour in the file; machined steel is assumed");
        return add(make_material({0.77, 0.776, 0.784}, "no_colour", 1.0F, 0.4F), "steel");
    }
    const std::string key = hex(*colour).substr(1);
    const double value = std::max({colour->r, colour->g, colour->b});
    if (colour->alpha < 0.999) {
        const std::string name = fmt::format("glass_{}_{:02X}", key, std::lround(colour->alpha * 255.0));
        guesses_.emplace(name, "transparent; glass is assumed");
        return add(make_material(*colour, name, 0.0F, 0.05F), "");
    }
    if (saturation(*colour) < 0.12 && value >= 0.35 && value <= 0.93) {
        guesses_.emplace("metal_" + key, "grey; metal is assumed");
        return add(make_material(*colour, "metal_" + key, 1.0F, 0.4F), "steel");
    }
    if (value < 0.25) {
        guesses_.emplace("plastic_" + key, "nearly black; plastic is assumed");
        return add(make_material(*colour, "plastic_" + key, 0.0F, 0.55F), "");
    }
    guesses_.emplace("paint_" + key, "paint is assumed");
    assets::Material paint = make_material(*colour, "paint_" + key, 0.0F, 0.5F);
    paint.clearcoat = 0.5F;
    paint.clearcoat_roughness = 0.2F;
    return add(std::move(paint), "");
}

int MaterialPicker::pick(const FaceAppearance& appearance) {
    if (appearance.colour)
        if (const TableMaterial* found = by_colour(*appearance.colour))
            return add(found->pbr, found->member_material);
    if (const TableMaterial* found = by_name(appearance))
        return found->tint && appearance.colour ? tinted(*found, *appearance.colour)
                                                : add(found->pbr, found->member_material);
    return guess(appearance.colour);
}

}  // namespace bolt::step_import
