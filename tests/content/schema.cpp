#include "content/format/schema.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/embedded.hpp"
#include "content/format/read_assembly.hpp"
#include "engine/base/file.hpp"
#include "support.hpp"

namespace content_schema_test {

using namespace bolt::content;
using namespace content_test;
using nlohmann::json;

namespace {

// Visits every object of a document with its path and its schema.
void each_object(const json& value, std::vector<std::string>& place,
                 const std::function<void(const std::vector<std::string>&, const json& schema)>& visit) {
    if (!value.is_structured()) return;
    const json* schema = schema_of(assembly_schema().json(), place);
    REQUIRE(schema != nullptr);
    if (value.is_object()) visit(place, *schema);
    for (const auto& [key, member] : value.items()) {
        place.push_back(key);
        each_object(member, place, visit);
        place.pop_back();
    }
}

json::json_pointer pointer(const std::vector<std::string>& place) {
    json::json_pointer result;
    for (const std::string& token : place) result /= token;
    return result;
}

std::vector<bolt::Error> errors_of(const json& document) {
    return parse_assembly(document.dump(1), "f").errors;
}

// Typing errors: a letter omitted, doubled, or two letters exchanged.
std::vector<std::string> misspellings(const std::string& name) {
    std::vector<std::string> result;
    const std::size_t middle = name.size() / 2;
    if (name.size() > 2) result.push_back(std::string(name).erase(middle, 1));
    result.push_back(std::string(name).insert(middle, 1, name[middle]));
    std::string turned = name;
    std::swap(turned[middle - 1], turned[middle]);
    if (turned != name) result.push_back(turned);
    return result;
}

void each_property_schema(const json& node,
                          const std::function<void(const std::string&, const json&)>& visit) {
    if (!node.is_structured()) return;
    if (node.is_object() && node.contains("properties"))
        for (const auto& [name, property] : node["properties"].items()) visit(name, property);
    for (const auto& [key, inner] : node.items())
        if (key != "properties" || !node.is_object())
            each_property_schema(inner, visit);
        else
            for (const auto& [name, property] : inner.items()) each_property_schema(property, visit);
}

}  // namespace

TEST_CASE("Schema: the built-in schema equals the file in content/") {
    const auto file = bolt::read_file(content_folder() / "schema" / "assembly.schema.json", 1U << 20U,
                                      bolt::ErrorCode::failed);
    REQUIRE(file);
    CHECK(*file == assembly_schema_text());
    CHECK(assembly_schema().json()["$schema"] == "http://json-schema.org/draft-07/schema#");
}

TEST_CASE("Schema: every property has a title and a description, and every object is closed") {
    each_property_schema(assembly_schema().json(), [](const std::string& name, const json& property) {
        CAPTURE(name);
        const json* at = &property;
        while (!at->contains("title") && at->contains("$ref"))
            at = &assembly_schema().json().at(json::json_pointer((*at)["$ref"].get<std::string>().substr(1)));
        CHECK(at->contains("title"));
        CHECK((at->contains("description") || at->contains("properties")));
    });
    for (const auto& entry : assembly_schema().json()["definitions"].items()) {
        const std::string& name = entry.key();
        const auto& definition = entry.value();
        CAPTURE(name);
        if (!definition.contains("properties")) continue;
        CHECK(definition.contains("additionalProperties"));
        if (name != "text_by_language") CHECK(definition["additionalProperties"] == false);
    }
}

TEST_CASE("Schema: every number has bounds") {
    each_property_schema(assembly_schema().json(), [](const std::string& name, const json& property) {
        CAPTURE(name);
        if (property.value("type", "") != "number") return;
        CHECK((property.contains("minimum") || property.contains("exclusiveMinimum")));
        CHECK(property.contains("maximum"));
    });
}

TEST_CASE("Schema: a file with every property loads, and the loader reads exactly the names of the schema") {
    std::vector<bolt::Error> errors;
    const auto document = JsonDocument::parse(everything(), "f", errors);
    REQUIRE(document);
    JsonReader reader(*document);
    for (const char* variant : {"", "weak"}) read_assembly(reader, variant);
    for (const bolt::Error& error : reader.take_errors()) FAIL_CHECK(error.message());

    std::set<std::string> in_schema;
    each_property_schema(assembly_schema().json(),
                         [&](const std::string& name, const json&) { in_schema.insert(name); });
    std::set<std::string> read(reader.names_read().begin(), reader.names_read().end());
    for (const char* own : {"plain", "weak", "one", "M12x1.25", "M12 stud", "clicker", "socket set"})
        read.erase(own);  // names defined by this file
    for (const std::string& name : in_schema) CHECK_MESSAGE(read.contains(name), name);
    for (const std::string& name : read) CHECK_MESSAGE(in_schema.contains(name), name);
}

TEST_CASE("Schema: the file with every property leaves none out") {
    const json document = json::parse(everything());
    std::vector<std::string> place;
    std::set<std::string> used, known;
    each_object(document, place, [&](const std::vector<std::string>& at, const json& schema) {
        for (const auto& [name, member] : document.at(pointer(at)).items())
            if (schema.contains("properties") && schema["properties"].contains(name)) used.insert(name);
    });
    each_property_schema(assembly_schema().json(),
                         [&](const std::string& name, const json&) { known.insert(name); });
    CHECK(used == known);
}

TEST_CASE("Schema: each missing required property gives exactly one error that names it") {
    const json document = json::parse(everything());
    std::vector<std::string> place;
    int count = 0;
    each_object(document, place, [&](const std::vector<std::string>& at, const json& schema) {
        for (const json& name : schema.value("required", json::array())) {
            const auto key = name.get<std::string>();
            json broken = document;
            broken.at(pointer(at)).erase(key);
            const auto errors = errors_of(broken);
            CAPTURE(key);
            CAPTURE(pointer(at).to_string());
            REQUIRE(errors.size() == 1);
            CHECK(errors[0].pointer == pointer(at).to_string());
            CHECK(errors[0].what == "required property \"" + key + "\" is missing");
            CHECK(errors[0].line > 0);
            ++count;
        }
    });
    CHECK(count > 30);
}

TEST_CASE("Schema: each misspelt property gives exactly one error with the correct name") {
    const json document = json::parse(everything());
    std::vector<std::string> place;
    int count = 0;
    each_object(document, place, [&](const std::vector<std::string>& at, const json& schema) {
        if (!schema.contains("properties") || schema["additionalProperties"] != false) return;
        const json& object = document.at(pointer(at));
        for (const auto& [name, member] : object.items())
            for (const std::string& wrong : misspellings(name)) {
                if (object.contains(wrong)) continue;
                json broken = document;
                broken.at(pointer(at)).erase(name);
                broken.at(pointer(at))[wrong] = member;
                const auto errors = errors_of(broken);
                CAPTURE(wrong);
                CAPTURE(pointer(at).to_string());
                REQUIRE(errors.size() == 1);
                CHECK(errors[0].what == "unknown property \"" + wrong + "\"");
                CHECK(errors[0].expected == "did you mean \"" + name + "\"?");
                CHECK(errors[0].pointer == (pointer(at) / wrong).to_string());
                ++count;
            }
    });
    CHECK(count > 250);
}

TEST_CASE("Schema: each value of a wrong type gives exactly one error at its position") {
    const json document = json::parse(everything());
    std::vector<std::string> place;
    each_object(document, place, [&](const std::vector<std::string>& at, const json& schema) {
        if (!schema.contains("properties")) return;
        for (const auto& entry : document.at(pointer(at)).items()) {
            const std::string& name = entry.key();
            const auto& member = entry.value();
            json broken = document;
            broken.at(pointer(at))[name] = member.is_boolean() ? json("yes") : json(true);
            const auto errors = errors_of(broken);
            CAPTURE((pointer(at) / name).to_string());
            REQUIRE(errors.size() == 1);
            CHECK(errors[0].pointer == (pointer(at) / name).to_string());
        }
    });
}

TEST_CASE("Schema: an error names the whole unit of a number") {
    const auto expected = [](const std::string& name) {
        const auto found =
            explain_value(assembly_schema().json(), {{"type", "number"}, {"minimum", 0}}, -1, name);
        REQUIRE(found.size() == 1);
        return found[0].expected;
    };
    CHECK(expected("pitch_mm") == "a number >= 0 (mm)");
    CHECK(expected("misfit_um") == "a number >= 0 (µm)");
    CHECK(expected("spring_rates_MN_per_mm") == "a number >= 0 (MN/mm)");
    CHECK(expected("interface_stiffness_GPa_per_m") == "a number >= 0 (GPa/m)");
    CHECK(expected("contact_end_mm2") == "a number >= 0 (mm²)");
    CHECK(expected("kappa1_Nm_per_deg2") == "a number >= 0 (N·m/deg²)");
    CHECK(expected("nu2") == "a number >= 0");
    CHECK(expected("friction_thread") == "a number >= 0");
    json document = json::parse(everything());
    document["flange"]["interface_stiffness_GPa_per_m"] = -1;
    const auto errors = errors_of(document);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].expected == "a number > 0 and <= 100000 (GPa/m)");
}

}  // namespace content_schema_test
