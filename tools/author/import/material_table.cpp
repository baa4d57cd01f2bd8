#include "tools/author/import/material_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>

#include "content/format/json_document.hpp"
#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "tools/author/import/embedded_materials.hpp"

namespace bolt::step_import {

namespace {

using content::JsonDocument;
using content::Part;
using nlohmann::json;

// One object of the file, its members asked for by name; what nobody asked for is a mistake.
class Members {
  public:
    Members(const JsonDocument& document, const json& object, std::string pointer, std::vector<Error>& errors,
            std::set<std::string>* keys)
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
            return wrong(key, "this is no usable number", fmt::format("expected {:g} to {:g}", least, most));
        value = found->get<float>();
    }

    void flag(const char* key, bool& value) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_boolean())
            return wrong(key, "this is neither true nor false", "expected true or false");
        value = found->get<bool>();
    }

    void text(const char* key, std::string& value) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_string()) return wrong(key, "this is no text", "expected a text in quotes");
        value = found->get<std::string>();
    }

    void texts(const char* key, std::vector<std::string>& values) {
        const json* found = find(key);
        if (found == nullptr) return;
        if (!found->is_array()) return wrong(key, "this is no list", "expected a list of texts");
        for (const json& item : *found) {
            if (!item.is_string())
                return wrong(key, "not all of these are texts", "expected a list of texts");
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
            wrong(key, fmt::format("{} is no colour", content::in_quotes(written)),
                  "expected sRGB as in \"#2F5D62\"");
    }

    void wrong(const std::string& key, std::string what, std::string expected) {
        errors_.push_back(document_.error(pointer_ + "/" + content::pointer_token(key), Part::value,
                                          std::move(what), std::move(expected)));
    }

    void no_others() {
        for (const auto& [key, value] : object_.items())
            if (std::find(known_.begin(), known_.end(), key) == known_.end())
                errors_.push_back(
                    document_.error(pointer_ + "/" + content::pointer_token(key), Part::key,
                                    fmt::format("nothing has the name {}", content::in_quotes(key)),
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

void read_look(Members& in, assets::Material& look) {
    glm::vec3 base{1.0F};
    in.colour("base_color", base);
    float alpha = 1.0F;
    in.number("alpha", alpha, 0.0, 1.0);
    look.base_color = {base, alpha};
    if (alpha < 1.0F) look.alpha_mode = assets::AlphaMode::blend;
    in.number("metallic", look.metallic, 0.0, 1.0);
    in.number("roughness", look.roughness, 0.0, 1.0);
    in.number("clearcoat", look.clearcoat, 0.0, 1.0);
    in.number("clearcoat_roughness", look.clearcoat_roughness, 0.0, 1.0);
    in.number("anisotropy", look.anisotropy, 0.0, 1.0);
    float degrees = 0.0F;
    in.number("anisotropy_rotation_deg", degrees, -360.0, 360.0);
    look.anisotropy_rotation = static_cast<float>(to_radians(static_cast<double>(degrees)));
    in.number("ior", look.ior, 1.0, 3.0);
    in.number("specular", look.specular, 0.0, 1.0);
    in.colour("specular_color", look.specular_color);
    in.flag("double_sided", look.double_sided);
}

TableMaterial read_material(Members& in, const std::string& name) {
    TableMaterial material;
    material.name = material.look.name = name;
    material.look.metallic = 0.0F;
    material.look.roughness = 0.5F;
    std::string ignored;
    in.text("description", ignored);
    in.texts("colors", material.colours);
    for (std::string& colour : material.colours) {
        if (const auto parsed = parse_hex(colour))
            colour = hex(*parsed);
        else
            in.wrong("colors", fmt::format("{} is no colour", content::in_quotes(colour)),
                     "expected sRGB as in \"#2F5D62\"");
    }
    in.texts("names", material.patterns);
    in.text("member", material.member);
    in.flag("tint", material.tint);
    read_look(in, material.look);
    in.no_others();
    return material;
}

void check_colours(const JsonDocument& document, const MaterialTable& table, std::vector<Error>& errors) {
    std::map<std::string, std::string> first;
    for (const TableMaterial& material : table.materials)
        for (const std::string& colour : material.colours) {
            const auto [known, fresh] = first.emplace(colour, material.name);
            if (fresh) continue;
            errors.push_back(
                document.error("/materials/" + content::pointer_token(material.name), Part::key,
                               fmt::format("{} means {} already", colour, content::in_quotes(known->second)),
                               "expected every colour once"));
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
        errors.push_back(document->error("", Part::value, "there is no object \"materials\" in this file",
                                         "expected { \"materials\": { \"my_paint\": { … } } }"));
        return;
    }
    Members top(*document, root, "", errors, keys);
    (void)top.find("materials");
    std::string ignored;
    top.text("$schema", ignored);
    top.text("sources", ignored);
    top.no_others();
    for (const auto& [name, value] : root["materials"].items()) {
        const std::string pointer = "/materials/" + content::pointer_token(name);
        if (!value.is_object()) {
            errors.push_back(document->error(pointer, Part::value, "this is no material",
                                             "expected an object: { \"base_color\": \"#C4C6C8\", … }"));
            continue;
        }
        Members members(*document, value, pointer, errors, keys);
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

}  // namespace bolt::step_import
