// Validates a document against the schema table. Properties that are not in the table are ignored, as the
// specification requires.
#include "engine/assets/read/schema.hpp"

#include <cfloat>
#include <climits>
#include <cmath>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

struct SchemaChecker {
    Document& document;

    Status check_object(nlohmann::json& value, const ObjectSchema& schema, const std::string& pointer);
    Status check_property(nlohmann::json& value, const Property& property, const std::string& pointer);
    Status check_list(nlohmann::json& value, const Property& property, const std::string& pointer);
    Status check_integer(nlohmann::json& value, const Property& property, const std::string& pointer);
    Status check_number(nlohmann::json& value, const Property& property, const std::string& pointer);
    Status check_index(nlohmann::json& value, const Property& property, const std::string& pointer);
};

// Returns the number of entries in a section that an index may refer to.
std::size_t section_size(const nlohmann::json& root, const std::string& section) {
    const nlohmann::json::json_pointer pointer(section.starts_with('/') ? section : '/' + section);
    if (!root.contains(pointer)) return 0;
    const nlohmann::json& entries = root.at(pointer);
    return entries.is_array() ? entries.size() : 0;
}

// The type of a JSON value with its article: "an object".
std::string type_phrase(const nlohmann::json& value) {
    const std::string name = value.type_name();
    if (value.is_null()) return name;
    return (value.is_structured() ? "an " : "a ") + name;
}

// Escapes a key for a JSON pointer (RFC 6901).
std::string escaped(const std::string& key) {
    std::string text;
    for (const char c : key) {
        if (c == '~') {
            text += "~0";
        } else if (c == '/') {
            text += "~1";
        } else {
            text += c;
        }
    }
    return text;
}

Status SchemaChecker::check_integer(nlohmann::json& value, const Property& property,
                                    const std::string& pointer) {
    // JSON and glTF accept 2.0 as an integer, but the libraries do not: convert it in the document.
    if (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>() &&
        value.get<double>() >= 0.0 && value.get<double>() <= INT_MAX)
        value = static_cast<std::uint64_t>(value.get<double>());
    const double low = std::max(property.low, 0.0);
    const double high = std::min(property.high, static_cast<double>(INT_MAX));
    if (!value.is_number_unsigned() || static_cast<double>(value.get<std::uint64_t>()) > high ||
        static_cast<double>(value.get<std::uint64_t>()) < low)
        return error_at(document, pointer,
                        "is " + (value.is_structured() ? type_phrase(value) : value.dump()),
                        "an integer from " + std::to_string(static_cast<int>(low)) + " to " +
                            std::to_string(static_cast<int>(high)));
    return {};
}

Status SchemaChecker::check_number(nlohmann::json& value, const Property& property,
                                   const std::string& pointer) {
    const double low = std::max(property.low, static_cast<double>(-FLT_MAX));
    const double high = std::min(property.high, static_cast<double>(FLT_MAX));
    if (!value.is_number()) return error_at(document, pointer, "is " + type_phrase(value), "a number");
    const double number = value.get<double>();
    if (number >= low && number <= high) return {};
    std::string expected = "a number that a float can hold";
    if (property.low > -DBL_MAX || property.high < DBL_MAX) {
        expected = "a number";
        if (property.low > -DBL_MAX) expected += " from " + nlohmann::json(property.low).dump();
        if (property.high < DBL_MAX) expected += " to " + nlohmann::json(property.high).dump();
    }
    return error_at(document, pointer, value.dump() + " is out of range", expected);
}

Status SchemaChecker::check_index(nlohmann::json& value, const Property& property,
                                  const std::string& pointer) {
    const std::size_t count = section_size(document.json, property.section);
    BOLT_TRY(check_integer(value, {}, pointer));
    if (value.get<std::uint64_t>() >= count)
        return error_at(document, pointer, "there is no entry " + value.dump() + " in " + property.section,
                        "an index below " + std::to_string(count));
    return {};
}

Status SchemaChecker::check_list(nlohmann::json& value, const Property& property,
                                 const std::string& pointer) {
    if (!value.is_array()) return error_at(document, pointer, "is " + type_phrase(value), "an array");
    if (property.length > 0 && value.size() != property.length)
        return error_at(document, pointer, "has " + std::to_string(value.size()) + " entries",
                        std::to_string(property.length) + " entries");
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::string entry_pointer = pointer + '/' + std::to_string(i);
        Status status;
        if (property.type == PropertyType::numbers) {
            status = check_number(value[i], property, entry_pointer);
        } else if (property.type == PropertyType::indices) {
            status = check_index(value[i], property, entry_pointer);
        } else if (property.type == PropertyType::strings) {
            if (!value[i].is_string())
                status = error_at(document, entry_pointer, "is " + type_phrase(value[i]), "a string");
        } else if (property.schema != nullptr) {
            status = check_object(value[i], *property.schema, entry_pointer);
        } else {  // a morph target: attributes by name
            status = check_property(
                value[i], {.name = "", .type = PropertyType::index_map, .section = property.section},
                entry_pointer);
        }
        if (!status) return status;
    }
    return {};
}

Status SchemaChecker::check_property(nlohmann::json& value, const Property& property,
                                     const std::string& pointer) {
    switch (property.type) {
        case PropertyType::boolean:
            if (!value.is_boolean())
                return error_at(document, pointer, "is " + type_phrase(value), "true or false");
            return {};
        case PropertyType::string:
            if (!value.is_string())
                return error_at(document, pointer, "is " + type_phrase(value), "a string");
            return {};
        case PropertyType::integer:
            return check_integer(value, property, pointer);
        case PropertyType::number:
            return check_number(value, property, pointer);
        case PropertyType::index:
            return check_index(value, property, pointer);
        case PropertyType::index_map:
            if (!value.is_object())
                return error_at(document, pointer, "is " + type_phrase(value), "an object");
            for (auto& [key, entry] : value.items())
                BOLT_TRY(check_index(entry, property, pointer + '/' + escaped(key)));
            return {};
        case PropertyType::object:
            return check_object(value, *property.schema, pointer);
        case PropertyType::numbers:
        case PropertyType::indices:
        case PropertyType::strings:
        case PropertyType::list:
            return check_list(value, property, pointer);
    }
    return {};
}

Status SchemaChecker::check_object(nlohmann::json& value, const ObjectSchema& schema,
                                   const std::string& pointer) {
    if (!value.is_object()) return error_at(document, pointer, "is " + type_phrase(value), "an object");
    for (const Property& property : schema) {
        const auto entry = value.find(property.name);
        if (entry == value.end()) {
            if (property.required)
                return error_at(document, pointer, "has no '" + std::string(property.name) + "'");
            continue;
        }
        BOLT_TRY(check_property(*entry, property, pointer + '/' + property.name));
    }
    return {};
}

Status check_version(const Document& document) {
    const nlohmann::json& asset = document.json["asset"];
    const std::string version = asset["version"];
    if (!version.starts_with("2."))
        return error_at(document, "/asset/version", "is glTF " + version, "glTF 2.0");
    if (asset.value("minVersion", "2.0") != "2.0")
        return error_at(document, "/asset/minVersion", "requires glTF " + asset.value("minVersion", ""),
                        "glTF 2.0");
    return {};
}

Status check_extensions(const Document& document) {
    constexpr std::string_view known[] = {
        "KHR_lights_punctual",     "KHR_materials_anisotropy",
        "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
        "KHR_materials_ior",       "KHR_materials_specular",
        "KHR_mesh_quantization",   "KHR_texture_transform",
    };
    const auto required = document.json.find("extensionsRequired");
    if (required == document.json.end()) return {};
    for (std::size_t i = 0; i < required->size(); ++i) {
        const std::string name = (*required)[i];
        if (std::find(std::begin(known), std::end(known), name) == std::end(known))
            return error_at(document, "/extensionsRequired/" + std::to_string(i),
                            "requires the extension " + name + ", which is not supported");
    }
    return {};
}

Status check_enumerator(const Document& document, const nlohmann::json& value,
                        std::initializer_list<const char*> allowed, const std::string& pointer) {
    std::string expected;
    for (const char* enumerator : allowed) {
        if (value == enumerator) return {};
        expected += (expected.empty() ? "" : ", ") + std::string(enumerator);
    }
    return error_at(document, pointer, "is " + value.dump(), "one of " + expected);
}

// Checks objects whose type determines their required properties.
Status check_types(const Document& document) {
    const nlohmann::json& root = document.json;
    Status status;
    const auto each = [&](const std::string& section, auto check) {
        const nlohmann::json::json_pointer path(section);
        if (!root.contains(path)) return;
        for (std::size_t i = 0; status && i < root.at(path).size(); ++i)
            status = check(root.at(path)[i], section + '/' + std::to_string(i));
    };
    each("/accessors", [&](const nlohmann::json& accessor, const std::string& pointer) {
        return check_enumerator(document, accessor["type"],
                                {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"},
                                pointer + "/type");
    });
    each("/cameras", [&](const nlohmann::json& camera, const std::string& pointer) -> Status {
        Status type_status =
            check_enumerator(document, camera["type"], {"perspective", "orthographic"}, pointer + "/type");
        if (!type_status || camera.contains(camera["type"])) return type_status;
        return error_at(document, pointer, "has no '" + camera["type"].get<std::string>() + "'");
    });
    each("/extensions/KHR_lights_punctual/lights",
         [&](const nlohmann::json& light, const std::string& pointer) -> Status {
             Status type_status = check_enumerator(document, light["type"], {"directional", "point", "spot"},
                                                   pointer + "/type");
             if (!type_status || light["type"] != "spot" || light.contains("spot")) return type_status;
             return error_at(document, pointer, "has no 'spot'");
         });
    return status;
}

}  // namespace

Status check_schema(Document& document) {
    SchemaChecker checker{document};
    Status status = checker.check_object(document.json, root_schema(), "");
    if (status) status = check_version(document);
    if (status) status = check_extensions(document);
    if (status) status = check_types(document);
    return status;
}

}  // namespace bolt::assets
