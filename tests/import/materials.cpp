// The table of materials: the shipped one, overrides by the author, errors, and guessed materials.
#include <doctest/doctest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "content/format/assembly.hpp"
#include "support.hpp"
#include "tools/author/import/materials.hpp"
#include "tools/author/import/names.hpp"

using namespace import_test;
using namespace bolt::step_import;
using nlohmann::json;

namespace {

MaterialTable shipped() {
    std::vector<Error> errors;
    MaterialTable table = load_materials("/nowhere", errors);
    for (const Error& error : errors) FAIL_CHECK(error.message());
    return table;
}

std::string picked_material(const MaterialTable& table, const FaceAppearance& appearance) {
    MaterialPicker picker(table);
    return picker.materials()[static_cast<std::size_t>(picker.pick(appearance))].name;
}

std::vector<Error> errors_of(const std::string& text) {
    MaterialTable table;
    std::vector<Error> errors;
    read_materials(text, "materials.json", table, errors);
    return errors;
}

}  // namespace

TEST_CASE("Import: every colour of the CAD palette selects its material") {
    const MaterialTable table = shipped();
    const std::pair<const char*, const char*> palette[] = {
        {"painted_cast_iron", "#2F5D62"},
        {"machined_cast_iron", "#A8A9A6"},
        {"machined_steel", "#C4C6C8"},
        {"gear_steel", "#8F9499"},
        {"bearing_steel", "#B4B8BC"},
        {"zinc_plated", "#D5D9DC"},
        {"black_oxide", "#2B2B2D"},
        {"stainless_steel", "#CFCFCB"},
        {"brass", "#C8A24A"},
        {"rubber", "#1A1A1A"},
        {"gasket", "#4A3B2A"},
        {"oil_film", "#B8860B"},
        {"sight_glass", "#DDEEFF"},
        {"chrome_vanadium", "#B9BCC2"},
        {"signal_red", "#B01E28"},
        {"galvanised_sheet", "#BFC4C6"},
    };
    for (const auto& entry : palette) {
        const char* const name = entry.first;
        const char* const colour = entry.second;
        CAPTURE(name);
        CHECK(picked_material(table, {parse_hex(colour), "", "", "anything"}) == name);
        // A rounding error of the CAD program does not change the colour.
        Colour off = *parse_hex(colour);
        off.r = std::min(1.0, off.r + 0.0015);
        CHECK(picked_material(table, {off, "", "", ""}) == name);
    }
    CHECK(table.materials.size() == std::size(palette));
    for (const TableMaterial& material : table.materials) {
        CAPTURE(material.name);
        // Only mixtures are neither metal nor dielectric.
        const bool mixed = material.name == "black_oxide" || material.name == "oil_film";
        CHECK((mixed || material.pbr.metallic == 0.0F || material.pbr.metallic == 1.0F));
        CHECK(material.pbr.roughness >= 0.04F);
    }
}

TEST_CASE(
    "Import: the CAD material comes before face and part names, the longest pattern wins, and paint keeps "
    "its colour") {
    const MaterialTable table = shipped();
    CHECK(picked_material(table, {{}, "", "", "casing_upper"}) == "painted_cast_iron");
    CHECK(picked_material(table, {{}, "", "", "O-Ring 40x3"}) == "rubber");
    CHECK(picked_material(table, {{}, "A2-70", "", "bolt_M16"}) == "stainless_steel");
    CHECK(picked_material(table, {{}, "", "brass insert", "bolt_M16"}) == "brass");
    CHECK(picked_material(table, {{}, "", "", "stainless steel bolt"}) == "stainless_steel");
    CHECK(picked_material(table, {parse_hex("#8899AA"), "", "", "casing_upper"}) ==
          "painted_cast_iron_8899AA");
    CHECK(picked_material(table, {parse_hex("#8899AA"), "", "", "bolt_M16"}) == "zinc_plated");
}

TEST_CASE("Import: an unknown colour gives a plausible material of that colour") {
    const MaterialTable table = shipped();
    MaterialPicker picker(table);
    const auto guessed = [&](const char* colour, double alpha = 1.0) {
        Colour parsed = *parse_hex(colour);
        parsed.alpha = alpha;
        return picker.materials()[static_cast<std::size_t>(picker.pick({parsed, "", "", "x"}))];
    };
    CHECK(guessed("#808284").metallic == 1.0F);
    CHECK(guessed("#101012").metallic == 0.0F);
    CHECK(guessed("#3366CC").metallic == 0.0F);
    CHECK(guessed("#3366CC").clearcoat > 0.0F);
    CHECK(guessed("#FFFFFF").metallic == 0.0F);
    CHECK(guessed("#3366CC", 0.5).alpha_mode == assets::AlphaMode::blend);
    // glTF colours are linear; IEC 61966-2-1: 0x33 = 0.2 → 0.0331.
    CHECK(guessed("#3366CC").base_color.r == doctest::Approx(0.0331).epsilon(0.002));
    CHECK(picker.guesses().size() == 5);  // one name each
    CHECK(picked_material(table, {}) == "no_colour");
}

TEST_CASE("Import: materials.json in the output folder overrides the shipped one") {
    const Folder folder;
    StepMaker maker;
    maker.part("thing", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), "#2F5D62");
    maker.write(folder / "thing.step");
    std::ofstream(folder / "materials.json")
        << R"({ "materials": { "painted_cast_iron": { "colors": ["#2F5D62"], "base_color": "#FF0000", "roughness": 0.9 } } })";
    REQUIRE(import(folder / "thing.step", folder.path()).ok());
    const assets::Model model = load(folder / "thing.glb");
    REQUIRE(model.materials.size() == 1);
    CHECK(model.materials[0].name == "painted_cast_iron");
    CHECK(model.materials[0].base_color == glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
    CHECK(model.materials[0].roughness == 0.9F);
    std::ofstream(folder / "materials.json") << R"({ "materials": { "mine": { "roughnes": 0.9 } } })";
    const auto imported = import(folder / "thing.step", folder.path());
    REQUIRE(imported.errors.size() == 1);
    CHECK(imported.errors[0].message().find("materials.json:1:") != std::string::npos);
    CHECK(imported.errors[0].expected.find("roughness") != std::string::npos);
    CHECK(imported.errors[0].code == ErrorCode::bad_content);
}

TEST_CASE("Import: errors in materials.json are found") {
    CHECK(errors_of(R"({ "materials": {} })").empty());
    CHECK(errors_of(R"({ "material": {} })").size() == 1);
    CHECK(errors_of("[]").size() == 1);
    CHECK(errors_of("{").size() == 1);
    CHECK(errors_of(R"({ "materials": { "a": 3 } })").size() == 1);
    CHECK(errors_of(R"({ "materials": { "a": { "base_color": "red" } } })").size() == 1);
    CHECK(errors_of(R"({ "materials": { "a": { "colors": ["#12345"] } } })").size() == 1);
    CHECK(errors_of(R"({ "materials": { "a": { "metallic": 2, "roughness": "low", "tint": 1 } } })").size() ==
          3);
    CHECK(errors_of(R"({ "materials": { "a": { "colors": ["#123456"] }, "b": { "colors": ["#123456"] } } })")
              .size() == 1);
}

TEST_CASE("Import: the schema of materials has exactly the keys that are read") {
    const json schema = json::parse(bytes(content::content_folder() / "schema" / "materials.schema.json"));
    MaterialTable table;
    std::vector<Error> errors;
    std::set<std::string> keys;
    read_materials(R"({ "materials": { "a": {} } })", "x", table, errors, &keys);
    std::set<std::string> described;
    for (const auto& [key, value] : schema["properties"].items()) described.insert(key);
    for (const auto& [key, value] : schema["definitions"]["material"]["properties"].items())
        described.insert(key);
    CHECK(keys == described);
    CHECK(schema["additionalProperties"] == false);
    CHECK(schema["definitions"]["material"]["additionalProperties"] == false);
}

TEST_CASE("Import: name patterns, generic names, cleaning and uniqueness") {
    CHECK(matches("*bolt*", "hex_BOLT_M16"));
    CHECK(matches("a*b*c", "aXbbYc"));
    CHECK(matches("*", ""));
    CHECK_FALSE(matches("*bolt", "bolts"));
    CHECK_FALSE(matches("", "x"));
    CHECK(is_meaningful_name("casing"));
    CHECK(is_meaningful_name("Solid oak"));
    for (const char* dull :
         {"", "NAUO12", "=>[0:1:1:2]", "SOLID", "Part 3", "17", "Open CASCADE STEP translator 7.6 1"}) {
        CAPTURE(dull);
        CHECK_FALSE(is_meaningful_name(dull));
    }
    CHECK(clean_name("  a\tb\n ") == "ab");
    CHECK(clean_name("\xFF\xC3\xA4") == "\xEF\xBF\xBD\xC3\xA4");
    CHECK(clean_name("\xED\xA0\x80").find('\xED') == std::string::npos);  // a surrogate is not a character
    UniqueNames names;
    CHECK(names.claim("a") == "a");
    CHECK(names.claim("a_2") == "a_2");
    CHECK(names.claim("a") == "a_3");
    CHECK(names.claim("") == "part");
}

TEST_CASE(
    "Import: tangents of turned steel run along the shaft and outwards on its ends, and paint has none") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("root");
    const TDF_Label shaft = maker.part("pin", BRepPrimAPI_MakeCylinder(10.0, 50.0).Shape(), "#C4C6C8");
    maker.place(root, shaft, "steel", moved(1.0, 0.0, 0.0));
    maker.paint(maker.place(root, shaft, "painted", moved(50.0, 0.0, 0.0)), "#2F5D62");
    maker.write(folder / "pins.step");
    step_import::ImportOptions options;
    options.far_level = true;
    REQUIRE(import(folder / "pins.step", folder / "out", options).ok());
    const assets::Model model = load(folder / "out" / "pins.glb");
    std::size_t with = 0;
    for (const assets::Mesh& mesh : model.meshes) {
        const assets::Primitive& primitive = mesh.primitives[0];
        const assets::Material& material = model.materials[static_cast<std::size_t>(primitive.material)];
        CHECK(primitive.tangents.empty() == (material.anisotropy == 0.0F));
        for (std::size_t i = 0; i < primitive.tangents.size(); ++i) {
            ++with;
            const glm::vec3 n = primitive.normals[i], t = glm::vec3(primitive.tangents[i]);
            CHECK(std::abs(glm::dot(n, t)) < 1e-5F);
            CHECK(std::abs(glm::length(t) - 1.0F) < 1e-5F);
            if (std::abs(n.y) < 0.5F) {
                CHECK(std::abs(t.y) > 0.9999F);
            } else {
                const glm::vec3 outward =
                    glm::normalize(primitive.positions[i] * glm::vec3(1.0F, 0.0F, 1.0F));
                CHECK(std::abs(glm::dot(t, outward)) > 0.999F);
            }
        }
    }
    CHECK(with > 50);
    for (const assets::Material& material : load(folder / "out" / "pins.far.glb").materials)
        CHECK(material.anisotropy == 0.0F);
}
