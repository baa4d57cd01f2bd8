// Validates a document against the schema table. Properties that are not in the table are ignored, as the
// specification requires.
#include "engine/assets/read/schema.hpp"

#include <cfloat>
#include <climits>
#include <cmath>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

namespace {

using nlohmann::json;

struct Checker {
    Document& document;

    Status object(json& value, const ObjectSchema& schema, const std::string& pointer);
    Status field(json& value, const Field& field, const std::string& pointer);
    Status list(json& value, const Field& field, const std::string& pointer);
    Status integer(json& value, const Field& field, const std::string& pointer);
    Status number(json& value, const Field& field, const std::string& pointer);
    Status index(json& value, const Field& field, const std::string& pointer);
};

// Returns the number of entries in a section that an index may refer to.
std::size_t section_size(const json& root, const std::string& section) {
    const json::json_pointer pointer(section.starts_with('/') ? section : '/' + section);
    if (!root.contains(pointer)) return 0;
    const json& entries = root.at(pointer);
    return entries.is_array() ? entries.size() : 0;
}

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

Status Checker::integer(json& value, const Field& field, const std::string& pointer) {
    // JSON and glTF accept 2.0 as an integer, but the libraries do not.
    if (value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>() &&
        std::abs(value.get<double>()) <= INT_MAX)
        value = static_cast<std::uint64_t>(std::abs(value.get<double>()));
    const double low = std::max(field.low, 0.0);
    const double high = std::min(field.high, static_cast<double>(INT_MAX));
    if (!value.is_number_unsigned() || static_cast<double>(value.get<std::uint64_t>()) > high ||
        static_cast<double>(value.get<std::uint64_t>()) < low)
        return error_at(document, pointer, value.dump() + " is not a number that can stand here",
                        "an integer from " + std::to_string(static_cast<int>(low)) + " to " +
                            std::to_string(static_cast<int>(high)));
    return {};
}

Status Checker::number(json& value, const Field& field, const std::string& pointer) {
    const double low = std::max(field.low, static_cast<double>(-FLT_MAX));
    const double high = std::min(field.high, static_cast<double>(FLT_MAX));
    if (!value.is_number())
        return error_at(document, pointer, "is " + std::string(value.type_name()), "a number");
    const double number = value.get<double>();
    if (number >= low && number <= high) return {};
    std::string expected = "a number that a float can hold";
    if (field.low > -DBL_MAX || field.high < DBL_MAX) {
        expected = "a number";
        if (field.low > -DBL_MAX) expected += " from " + json(field.low).dump();
        if (field.high < DBL_MAX) expected += " to " + json(field.high).dump();
    }
    return error_at(document, pointer, value.dump() + " is out of range", expected);
}

Status Checker::index(json& value, const Field& field, const std::string& pointer) {
    const std::size_t count = section_size(document.json, field.section);
    BOLT_TRY(integer(value, {}, pointer));
    if (value.get<std::uint64_t>() >= count)
        return error_at(document, pointer, "there is no entry " + value.dump() + " in " + field.section,
                        "an index below " + std::to_string(count));
    return {};
}

Status Checker::list(json& value, const Field& field, const std::string& pointer) {
    if (!value.is_array())
        return error_at(document, pointer, "is " + std::string(value.type_name()), "an array");
    if (field.length > 0 && value.size() != field.length)
        return error_at(document, pointer, "has " + std::to_string(value.size()) + " entries",
                        std::to_string(field.length) + " entries");
    for (std::size_t i = 0; i < value.size(); ++i) {
        const std::string place = pointer + '/' + std::to_string(i);
        Status status;
        if (field.kind == FieldType::numbers) {
            status = number(value[i], field, place);
        } else if (field.kind == FieldType::indices) {
            status = index(value[i], field, place);
        } else if (field.kind == FieldType::strings) {
            if (!value[i].is_string()) status = error_at(document, place, "is no text", "a string");
        } else if (field.schema != nullptr) {
            status = object(value[i], *field.schema, place);
        } else {  // a morph target: attributes by name
            status = this->field(value[i],
                                 {.name = "", .kind = FieldType::index_map, .section = field.section}, place);
        }
        if (!status) return status;
    }
    return {};
}

Status Checker::field(json& value, const Field& field, const std::string& pointer) {
    switch (field.kind) {
        case FieldType::boolean:
            if (!value.is_boolean()) return error_at(document, pointer, "is no truth value", "true or false");
            return {};
        case FieldType::string:
            if (!value.is_string())
                return error_at(document, pointer, "is " + std::string(value.type_name()), "a string");
            return {};
        case FieldType::integer:
            return integer(value, field, pointer);
        case FieldType::number:
            return number(value, field, pointer);
        case FieldType::index:
            return index(value, field, pointer);
        case FieldType::index_map:
            if (!value.is_object())
                return error_at(document, pointer, "is " + std::string(value.type_name()), "an object");
            for (auto& [key, entry] : value.items())
                BOLT_TRY(index(entry, field, pointer + '/' + escaped(key)));
            return {};
        case FieldType::object:
            return object(value, *field.schema, pointer);
        case FieldType::numbers:
        case FieldType::indices:
        case FieldType::strings:
        case FieldType::list:
            return list(value, field, pointer);
    }
    return {};
}

Status Checker::object(json& value, const ObjectSchema& schema, const std::string& pointer) {
    if (!value.is_object())
        return error_at(document, pointer, "is " + std::string(value.type_name()), "an object");
    for (const Field& field : schema) {
        const auto entry = value.find(field.name);
        if (entry == value.end()) {
            if (field.required)
                return error_at(document, pointer, "has no '" + std::string(field.name) + "'");
            continue;
        }
        BOLT_TRY(this->field(*entry, field, pointer + '/' + field.name));
    }
    return {};
}

Status check_version(const Document& document) {
    const json& asset = document.json["asset"];
    const std::string version = asset["version"];
    if (!version.starts_with("2."))
        return error_at(document, "/asset/version", "is glTF " + version, "glTF 2.0");
    if (asset.value("minVersion", "2.0") != "2.0")
        return error_at(document, "/asset/minVersion", "needs glTF " + asset.value("minVersion", ""),
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
                            "needs the extension " + name + ", which is not read here");
    }
    return {};
}

Status check_word(const Document& document, const json& value, std::initializer_list<const char*> words,
                  const std::string& pointer) {
    std::string expected;
    for (const char* word : words) {
        if (value == word) return {};
        expected += (expected.empty() ? "" : ", ") + std::string(word);
    }
    return error_at(document, pointer, "is " + value.dump(), "one of " + expected);
}

// Checks objects whose type determines their required properties.
Status check_types(const Document& document) {
    const json& root = document.json;
    Status status;
    const auto each = [&](const std::string& section, auto check) {
        const json::json_pointer path(section);
        if (!root.contains(path)) return;
        for (std::size_t i = 0; status && i < root.at(path).size(); ++i)
            status = check(root.at(path)[i], section + '/' + std::to_string(i));
    };
    each("/accessors", [&](const json& accessor, const std::string& pointer) {
        return check_word(document, accessor["type"],
                          {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"}, pointer + "/type");
    });
    each("/cameras", [&](const json& camera, const std::string& pointer) -> Status {
        Status word =
            check_word(document, camera["type"], {"perspective", "orthographic"}, pointer + "/type");
        if (!word || camera.contains(camera["type"])) return word;
        return error_at(document, pointer, "has no '" + camera["type"].get<std::string>() + "'");
    });
    each("/extensions/KHR_lights_punctual/lights",
         [&](const json& light, const std::string& pointer) -> Status {
             Status word =
                 check_word(document, light["type"], {"directional", "point", "spot"}, pointer + "/type");
             if (!word || light["type"] != "spot" || light.contains("spot")) return word;
             return error_at(document, pointer, "has no 'spot'");
         });
    return status;
}

}  // namespace

Status check_schema(Document& document) {
    Checker checker{document};
    Status status = checker.object(document.json, root_schema(), "");
    if (status) status = check_version(document);
    if (status) status = check_extensions(document);
    if (status) status = check_types(document);
    return status;
}

}  // namespace bolt::assets
