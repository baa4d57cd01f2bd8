#include "content/format/read_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "content/format/json_document.hpp"
#include "content/format/read_joints.hpp"

namespace bolt::content {

namespace {

constexpr double default_field_of_view = to_radians(40.0);

// Returns how many of the joints the flange couples: those of its types, or all if it names none.
std::size_t coupled_joints(JsonReader& reader, const JsonNode& types,
                           const std::vector<AssemblyJoint>& joints) {
    if (!types) return joints.size();
    const JsonNode all = reader.member(reader.root(), "joint_types");
    std::vector<std::string> known, named;
    for (const JsonNode& type : reader.items(all)) known.push_back(last_token(type.pointer));
    for (const JsonNode& item : reader.items(types)) {
        named.push_back(reader.text(item).value_or(""));
        if (!known.empty() && std::find(known.begin(), known.end(), named.back()) == known.end() &&
            reader.is_valid(item.pointer))
            reader.report(item.pointer,
                          fmt::format("{} is not a joint type of this file", in_quotes(named.back())),
                          suggest(named.back(), known));
    }
    return static_cast<std::size_t>(
        std::count_if(joints.begin(), joints.end(), [&](const AssemblyJoint& joint) {
            return std::find(named.begin(), named.end(), joint.type) != named.end();
        }));
}

FlangeDesign read_flange(JsonReader& reader, const std::string& variant,
                         const std::vector<AssemblyJoint>& joints) {
    const JsonNode node = reader.member(reader.root(), "flange");
    const LayeredObject file(reader, {node});
    FlangeDesign flange;
    flange.thickness = file.number("thickness_mm").value_or(0.0) * mm;
    flange.E = file.number("E_GPa").value_or(0.0) * 1e9;
    flange.poisson = file.number("poisson").value_or(flange.poisson);
    flange.interface_stiffness = file.number("interface_stiffness_GPa_per_m").value_or(0.0) * 1e9;
    const JsonNode types = reader.member(node, "joint_types");
    const std::size_t coupled = coupled_joints(reader, types, joints);
    flange.joints_interact = node && (coupled > 0 || joints.empty());
    const bool types_known = std::none_of(joints.begin(), joints.end(),
                                          [](const AssemblyJoint& joint) { return joint.type.empty(); });
    if (node && types_known && coupled > 0 && coupled < joints.size()) {
        const JsonNode selection = variant_joint_list(reader, variant);
        reader.report(selection ? selection.pointer : types.pointer,
                      fmt::format("the flange couples {} of the {} joints", coupled, joints.size()),
                      "all of them, or none");
    }
    return flange;
}

// Reads the views of the file and those that a variant adds.
std::vector<NamedView> read_views(JsonReader& reader, const JsonNode& variant) {
    std::vector<NamedView> views;
    std::vector<JsonNode> nodes = reader.items(reader.member(reader.root(), "views"));
    const std::vector<JsonNode> added = reader.items(reader.member(variant, "views"));
    nodes.insert(nodes.end(), added.begin(), added.end());
    for (const JsonNode& node : nodes) {
        NamedView view;
        const JsonNode name = reader.member(node, "name");
        view.name = reader.text(name).value_or("");
        view.eye = reader.vector(reader.member(node, "eye_mm")).value_or(Vec3{0.0}) * mm;
        view.target = reader.vector(reader.member(node, "target_mm")).value_or(Vec3{0.0}) * mm;
        view.field_of_view = default_field_of_view;
        if (const auto angle = reader.number(reader.member(node, "field_of_view_deg")))
            view.field_of_view = to_radians(*angle);
        if (name &&
            std::any_of(views.begin(), views.end(), [&](const NamedView& v) { return v.name == view.name; }))
            reader.report(name.pointer, fmt::format("there are two views {}", in_quotes(view.name)),
                          "a name of its own");
        const Vec3 line_of_sight = view.target - view.eye;
        if (reader.is_valid(node.pointer) && glm::dot(line_of_sight, line_of_sight) < 1e-12)
            reader.report(reader.member(node, "target_mm").pointer, "the target of the view is its eye point",
                          "another point");
        views.push_back(std::move(view));
    }
    return views;
}

std::string suggest_variant(std::string_view name, const std::vector<std::string>& known) {
    return known.empty() ? "none: the file has no variants" : suggest(name, known);
}

// The variant to use: the requested one, else the file's default, else none.
std::string choose_variant(JsonReader& reader, std::string_view requested,
                           const std::vector<AssemblyVariant>& variants) {
    std::vector<std::string> names;
    for (const AssemblyVariant& v : variants) names.push_back(v.name);
    const auto known = [&](std::string_view name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const JsonNode all = reader.member(reader.root(), "variants");
    const JsonNode node = reader.member(reader.root(), "default_variant");
    const std::string fallback = reader.text(node).value_or("");
    if (node && !known(fallback) && reader.is_valid(all.pointer))
        reader.report(node.pointer, fmt::format("{} is not a variant of this file", in_quotes(fallback)),
                      suggest_variant(fallback, names));
    if (requested.empty()) return known(fallback) ? fallback : std::string{};
    if (!known(requested) && reader.is_valid(all.pointer))
        reader.report(all.pointer,
                      fmt::format("the requested variant {} is not in this file", in_quotes(requested)),
                      suggest_variant(requested, names));
    return known(requested) ? std::string(requested) : known(fallback) ? fallback : std::string{};
}

JsonNode variant_of(JsonReader& reader, const std::string& variant) {
    return variant.empty() ? JsonNode{} : reader.member(reader.member(reader.root(), "variants"), variant);
}

// The text of the variant or, if it has none, of the file.
std::map<std::string, std::string> read_lesson(JsonReader& reader, const std::string& variant) {
    const JsonNode own = reader.member(variant_of(reader, variant), "lesson");
    return read_texts(reader, own ? own : reader.member(reader.root(), "lesson"));
}

}  // namespace

JsonNode variant_joint_list(JsonReader& reader, const std::string& variant) {
    return reader.member(variant_of(reader, variant), "joints");
}

Assembly read_assembly(JsonReader& reader, std::string_view variant, const ModelFolders& folders) {
    Assembly assembly;
    const JsonNode root = reader.root();
    reader.member(root, "$schema");  // for editors only
    assembly.title = read_texts(reader, reader.member(root, "title"));
    assembly.sources = reader.text(reader.member(root, "sources")).value_or("");
    if (const auto law = reader.text(reader.member(root, "law")))
        assembly.law = joint::law_named(*law).value_or(assembly.law);
    assembly.models = read_model_files(reader, root, folders);

    for (const JsonNode& node : reader.items(reader.member(root, "variants")))
        assembly.variants.push_back(
            {last_token(node.pointer), read_texts(reader, reader.member(node, "title"))});
    // In the order of the file, as the author lists them; the document sorts members by name.
    const auto line_of = [&](const AssemblyVariant& listed) {
        return reader.line(reader.member(reader.member(root, "variants"), listed.name).pointer,
                           JsonPart::key);
    };
    std::stable_sort(
        assembly.variants.begin(), assembly.variants.end(),
        [&](const AssemblyVariant& a, const AssemblyVariant& b) { return line_of(a) < line_of(b); });
    assembly.variant = choose_variant(reader, variant, assembly.variants);
    // The other variants are read only to report their errors. Without a default variant the plain file can
    // be chosen too.
    for (const AssemblyVariant& other : assembly.variants)
        if (other.name != assembly.variant) {
            const VariantJoints joints = read_variant_joints(reader, other.name);
            const std::vector<NamedView> views = read_views(reader, variant_of(reader, other.name));
            read_flange(reader, other.name, joints.joints);
            read_tools(reader, other.name, joints, folders);
            read_passes(reader, {joints, views, other.name, folders});
            read_lesson(reader, other.name);
            read_added_models(reader, other.name, folders);
        }
    VariantJoints joints = read_variant_joints(reader, assembly.variant);
    assembly.lesson_texts = read_lesson(reader, assembly.variant);
    assembly.views = read_views(reader, variant_of(reader, assembly.variant));
    assembly.flange = read_flange(reader, assembly.variant, joints.joints);
    assembly.added_models = read_added_models(reader, assembly.variant, folders);
    assembly.tools = read_tools(reader, assembly.variant, joints, folders);
    assembly.tool = assembly.tools.front().name;
    assembly.wrench = assembly.tools.front().wrench;
    AssemblyPasses passes = read_passes(reader, {joints, assembly.views, assembly.variant, folders});
    assembly.joints = std::move(joints.joints);
    assembly.passes = std::move(passes.tightening);
    assembly.loosening = std::move(passes.loosening);
    return assembly;
}

namespace fs = std::filesystem;

namespace {

// A kind of file that an assembly refers to, as its extensions.
struct ReferencedFileKind {
    std::vector<std::string> extensions;
    const char* what;    // "is not <what>"
    const char* remedy;  // the "expected" of that message
};
const ReferencedFileKind model_kind{
    {".glb"}, "a .glb file", "a binary glTF file: bolt-author import-step makes one from STEP"};
const ReferencedFileKind picture_kind{{".png", ".jpg", ".jpeg"}, "a picture", "a file .png, .jpg or .jpeg"};

bool has_extension(const fs::path& path, const ReferencedFileKind& kind) {
    return std::find(kind.extensions.begin(), kind.extensions.end(), path.extension().string()) !=
           kind.extensions.end();
}

// Names of the files of this kind in a folder.
std::vector<std::string> files_in(const fs::path& folder, const ReferencedFileKind& kind) {
    std::vector<std::string> names;
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem))
        if (has_extension(entry->path(), kind)) names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool is_in_folder(const fs::path& inner, const fs::path& folder) {
    std::error_code problem;
    const fs::path whole = fs::weakly_canonical(fs::absolute(inner), problem);
    return !problem &&
           std::mismatch(folder.begin(), folder.end(), whole.begin(), whole.end()).first == folder.end();
}

// A folder that a value's path is relative to.
struct PathBase {
    fs::path folder;
    fs::path root;  // files outside it are rejected; empty: files are not checked
    std::string_view text;
};

// The path of the file that a value refers to; empty after an error. Its existence is checked only if the
// base has a root.
std::string read_file_name(JsonReader& reader, const JsonNode& node, const PathBase& base,
                           const ReferencedFileKind& kind) {
    const auto& [folder, root, folder_text] = base;
    const auto name = reader.text(node);
    if (!name) return {};
    const fs::path given(*name);
    if (given.is_absolute() || name->find('\\') != std::string::npos ||
        name->find(':') != std::string::npos) {
        reader.report(node.pointer, fmt::format("{} is not a relative path", in_quotes(*name)),
                      fmt::format("a path from {}, with / between folders", folder_text));
        return {};
    }
    if (!has_extension(given, kind)) {
        reader.report(node.pointer, fmt::format("{} is not {}", in_quotes(*name), kind.what), kind.remedy);
        return {};
    }
    fs::path path = (folder / given).lexically_normal();
    if (root.empty()) return path.string();
    if (!is_in_folder(path, root)) {
        const bool own = is_in_folder(root, fs::weakly_canonical(fs::absolute(folder)));
        reader.report(
            node.pointer,
            fmt::format("{} is outside {}", in_quotes(*name), own ? folder_text : "the content folder"),
            fmt::format("a file in {}", own ? folder_text : "the content folder"));
        return {};
    }
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        const std::vector<std::string> known = files_in(path.parent_path(), kind);
        reader.report(node.pointer, fmt::format("there is no file {} in {}", in_quotes(*name), folder_text),
                      known.empty() ? fmt::format("a file; no {} is there", kind.extensions.front())
                                    : suggest(given.filename().string(), known));
        return {};
    }
    return path.string();
}

}  // namespace

std::map<std::string, std::string> read_texts(JsonReader& reader, const JsonNode& node) {
    for (const char* language : {"en", "de", "zh"})
        reader.member(node, language);  // known names; other codes are accepted too
    return reader.texts(node);
}

ModelFiles read_model_files(JsonReader& reader, const JsonNode& object, const ModelFolders& folders) {
    const auto read = [&](std::string_view key) {
        return read_file_name(reader, reader.member(object, key),
                              {folders.folder, folders.root, "the assembly's folder"}, model_kind);
    };
    return {read("model"), read("model_far"), read("contact_model")};
}

ModelFiles read_added_models(JsonReader& reader, const std::string& variant, const ModelFolders& folders) {
    const JsonNode added = reader.member(variant_of(reader, variant), "added_models");
    for (const char* key : {"model", "model_far", "contact_model"}) {
        const JsonNode own = reader.member(added, key), file = reader.member(reader.root(), key);
        if (own && !file && reader.is_valid(file.pointer))
            reader.report(own.pointer, fmt::format("the file names no {} to add to", in_quotes(key)),
                          fmt::format("no {} here", in_quotes(key)));
        if (added && file && !own && reader.is_valid(own.pointer))
            reader.report(added.pointer,
                          fmt::format("the added models lack {}, which the file names", in_quotes(key)),
                          fmt::format("{} of the added parts", in_quotes(key)));
    }
    return read_model_files(reader, added, folders);
}

std::string read_tool_model(JsonReader& reader, const JsonNode& tool, const ModelFolders& folders) {
    // Tools are shared by all assemblies, so their models are in one folder.
    const JsonNode node = reader.member(tool, "model");
    const fs::path root = folders.root.empty() ? fs::path{} : fs::weakly_canonical(folders.tools);
    return read_file_name(reader, node, {folders.tools, root, "content/tools"}, model_kind);
}

Instruction read_instruction(JsonReader& reader, const JsonNode& pass, const PassReferences& context) {
    const JsonNode node = reader.member(pass, "instruction");
    Instruction instruction;
    instruction.text = read_texts(reader, reader.member(node, "text"));
    const JsonNode view = reader.member(node, "view");
    instruction.view = reader.text(view).value_or("");
    std::vector<std::string> names;
    for (const NamedView& known : context.views) names.push_back(known.name);
    const bool is_view = std::find(names.begin(), names.end(), instruction.view) != names.end();
    const bool views_are_known = reader.is_valid(reader.member(reader.root(), "views").pointer);
    if (view && !is_view && views_are_known && reader.is_valid(view.pointer))
        reader.report(
            view.pointer, fmt::format("{} is not a view of this file", in_quotes(instruction.view)),
            names.empty() ? "a name in \"views\"; the file has none" : suggest(instruction.view, names));
    instruction.picture =
        read_file_name(reader, reader.member(node, "picture"),
                       {context.folders.folder, context.folders.root, "the assembly's folder"}, picture_kind);
    return instruction;
}

}  // namespace bolt::content
