#include "content/format/assembly.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "content/format/embedded.hpp"
#include "content/format/json_document.hpp"
#include "content/format/json_syntax.hpp"
#include "content/format/read_assembly.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace {

std::size_t tool_index(const Assembly& assembly, std::string_view name) {
    const auto found = std::find_if(assembly.tools.begin(), assembly.tools.end(),
                                    [&](const Tool& tool) { return tool.name == name; });
    return found == assembly.tools.end() ? 0 : static_cast<std::size_t>(found - assembly.tools.begin());
}

}  // namespace

std::size_t tool_if_chosen(const Assembly& assembly, const AssemblyJoint& joint, std::string_view chosen) {
    if (!joint.tool.empty()) return tool_index(assembly, joint.tool);
    const std::size_t tool = tool_index(assembly, chosen);
    if (tool >= assembly.tools.size()) return tool;
    const auto other = assembly.tools[tool].instead.find(joint.design.id);
    return other == assembly.tools[tool].instead.end() ? tool : tool_index(assembly, other->second);
}

LessonTools lesson_tools(const Assembly& assembly) {
    LessonTools lesson;
    lesson.of_joint.assign(assembly.joints.size(), 0);
    const auto add = [&](std::size_t joint) {
        const std::size_t tool = tool_if_chosen(assembly, assembly.joints[joint], assembly.tool);
        const auto known = std::find(lesson.tools.begin(), lesson.tools.end(), tool);
        lesson.of_joint[joint] = static_cast<std::size_t>(known - lesson.tools.begin());
        if (known == lesson.tools.end()) lesson.tools.push_back(tool);
    };
    if (!assembly.passes.empty())
        for (const std::size_t joint : assembly.passes.front().order) add(joint);
    for (std::size_t joint = 0; joint < assembly.joints.size(); ++joint) add(joint);
    return lesson;
}

namespace {

// The design of the chosen tool may have been changed since it was chosen.
const WrenchDesign& design_of(const Assembly& assembly, std::size_t tool) {
    const bool chosen = tool >= assembly.tools.size() || assembly.tools[tool].name == assembly.tool;
    return chosen ? assembly.wrench : assembly.tools[tool].wrench;
}

}  // namespace

std::vector<const WrenchDesign*> designs_of(const Assembly& assembly, const LessonTools& lesson) {
    std::vector<const WrenchDesign*> designs;
    for (const std::size_t tool : lesson.tools) designs.push_back(&design_of(assembly, tool));
    return designs;
}

const WrenchDesign& tool_of(const Assembly& assembly, const AssemblyJoint& joint) {
    return design_of(assembly, tool_if_chosen(assembly, joint, assembly.tool));
}

std::string turned_node(const AssemblyJoint& joint) {
    return joint.design.id + (joint.design.turned == joint::TurnedPart::head ? "_bolt" : "_nut");
}

bool is_turned_node(const AssemblyJoint& joint, std::string_view mesh_node) {
    if (mesh_node == turned_node(joint)) return true;
    return joint.design.turned == joint::TurnedPart::head && !mesh_node.empty() && mesh_node == joint.node;
}

bool is_held_node(const AssemblyJoint& joint, std::string_view mesh_node) {
    if (joint.design.counter_hold == joint::CounterHold::fixed) return false;
    const bool head_is_turned = joint.design.turned == joint::TurnedPart::head;
    return mesh_node == joint.design.id + (head_is_turned ? "_nut" : "_bolt");
}

std::vector<std::string> model_paths(const Assembly& assembly, ModelFile file) {
    if ((assembly.models.*file).empty()) return {};
    std::vector<std::string> parts{assembly.models.*file};
    if (!(assembly.added_models.*file).empty()) parts.push_back(assembly.added_models.*file);
    return parts;
}

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_errors = 200;  // reported per file

LoadedAssembly failed(std::string file, std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = std::move(file);
    error.what = std::move(what);
    error.expected = std::move(expected);
    LoadedAssembly loaded;
    loaded.errors.push_back(std::move(error));
    return loaded;
}

LoadedAssembly unknown_assembly(const std::string& name, const std::vector<std::string>& names) {
    const std::string best = nearest_name(name, names);
    std::string expected_text = fmt::format(
        "{}one of {}", best.empty() ? "" : fmt::format("did you mean {}? expected ", in_quotes(best)),
        fmt::join(names, ", "));
    if (names.empty())
        expected_text = content_folder().empty() ? "a content folder; BOLTWRIGHT_CONTENT names it"
                                                 : "an assembly in content/";
    return failed(name, "there is no such folder, file or assembly", std::move(expected_text));
}

// Sessions are SQLite files, which begin with this text.
bool is_session(const fs::path& file) {
    constexpr std::string_view magic = "SQLite format 3";
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored)) return false;
    char begin[magic.size()] = {};
    std::ifstream(file, std::ios::binary).read(begin, sizeof begin);
    return std::string_view(begin, sizeof begin) == magic;
}

std::string folder_name(const fs::path& file) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(file, ignored).lexically_normal();
    return whole.parent_path().filename().string();
}

fs::path canonical_path(const fs::path& path) {
    std::error_code problem;
    fs::path whole = fs::weakly_canonical(fs::absolute(path), problem);
    return problem ? path : whole;
}

// An assembly in content/ may refer to files in content/, any other assembly to files in its own folder. The
// models of tools are in content/tools for both.
ModelFolders model_folders(const fs::path& file) {
    const fs::path folder = canonical_path(file).parent_path(), content = canonical_path(content_folder());
    const auto differs = std::mismatch(content.begin(), content.end(), folder.begin(), folder.end());
    const bool inside = !content.empty() && differs.first == content.end();
    return {file.parent_path(), content_folder() / "tools", inside ? content : folder};
}

LoadedAssembly parse(std::string_view text, std::string_view file, std::string_view variant,
                     const ModelFolders& folders) {
    LoadedAssembly loaded;
    loaded.assembly.file = file;
    loaded.assembly.text = text;
    const auto document = JsonDocument::parse(text, file, loaded.errors);
    if (!document) return loaded;
    const std::vector<Error> repeated = std::move(loaded.errors);
    JsonReader reader(*document);
    Assembly assembly = read_assembly(reader, variant, folders);
    assembly.name = folder_name(fs::path(file));
    assembly.file = std::move(loaded.assembly.file);
    assembly.text = std::move(loaded.assembly.text);
    loaded.assembly = std::move(assembly);
    loaded.errors = reader.take_errors();
    loaded.errors.insert(loaded.errors.begin(), repeated.begin(), repeated.end());
    sort_by_position(loaded.errors);
    if (loaded.errors.size() > max_errors) {
        loaded.errors.resize(max_errors);
        Error last = loaded.errors.back();
        last.pointer.clear();
        last.what = "further errors are not shown: fix those above first";
        last.expected.clear();
        loaded.errors.push_back(std::move(last));
    }
    return loaded;
}

}  // namespace

LoadedAssembly parse_assembly(std::string_view text, std::string_view file, std::string_view variant) {
    return parse(text, file, variant, {fs::path(file).parent_path(), "tools", {}});
}

std::vector<const Tool*> choosable_tools(const Assembly& assembly) {
    std::vector<const Tool*> tools;
    for (const Tool& tool : assembly.tools) {
        const bool own = std::any_of(assembly.joints.begin(), assembly.joints.end(),
                                     [&](const AssemblyJoint& joint) { return joint.tool == tool.name; });
        if (tools.empty() || !own) tools.push_back(&tool);
    }
    return tools;
}

std::vector<std::size_t> tools_of_joint(const Assembly& assembly, std::size_t joint) {
    std::vector<std::size_t> tools;
    for (const Tool* chosen : choosable_tools(assembly)) {
        const std::size_t tool = tool_if_chosen(assembly, assembly.joints[joint], chosen->name);
        if (std::find(tools.begin(), tools.end(), tool) == tools.end()) tools.push_back(tool);
    }
    return tools;
}

Status choose_tool(Assembly& assembly, std::string_view name) {
    std::vector<std::string> names;
    for (const Tool* tool : choosable_tools(assembly)) {
        names.push_back(tool->name);
        if (tool->name != name && !(name.empty() && names.size() == 1)) continue;
        assembly.tool = tool->name;
        assembly.wrench = tool->wrench;
        return {};
    }
    const bool known = std::any_of(assembly.tools.begin(), assembly.tools.end(),
                                   [&](const Tool& tool) { return tool.name == name; });
    Error error;
    error.code = ErrorCode::bad_content;
    error.file = assembly.file;
    error.what = known ? fmt::format("the tool {} turns only the joints that name it", in_quotes(name))
                       : fmt::format("there is no tool {} in this file", in_quotes(name));
    error.expected = suggest(name, names);
    return fail(error);
}

LoadedAssembly load_assembly(const fs::path& where, std::string_view variant) {
    std::error_code ignored;
    const bool folder = fs::is_directory(where, ignored);
    fs::path file = folder ? where / "assembly.json" : where;
    if (!fs::exists(file, ignored)) {
        const std::vector<std::string> names = assembly_names();
        if (std::find(names.begin(), names.end(), where.string()) == names.end())
            return folder
                       ? failed(where.string(), "this folder has no assembly.json", "a folder of an assembly")
                       : unknown_assembly(where.string(), names);
        file = assembly_folder(where.string()) / "assembly.json";
    }
    if (is_session(file))
        return failed(file.string(), "this is a session, not an assembly",
                      "the folder of an assembly, or its assembly.json");
    const auto text = read_file(file, json_size_limit, ErrorCode::bad_content);
    if (!text) {
        LoadedAssembly loaded;
        loaded.errors.push_back(text.error());
        return loaded;
    }
    return parse(*text, file.string(), variant, model_folders(file));
}

namespace {

constexpr std::string_view schema_name = "assembly.schema.json";
constexpr std::size_t model_size_limit = 64U << 20U;  // bytes

tl::unexpected<Error> path_error(const fs::path& path, ErrorCode code, std::string what,
                                 std::string expected) {
    Error error;
    error.code = code;
    error.file = path.string();
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

// Replaces the value at a JSON pointer in the text itself, so that the author's formatting is preserved.
void replace_value(std::string& text, const char* pointer, std::string_view value) {
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, {}, errors);
    if (!document) return;
    const std::size_t start = document->offset(pointer);
    // The name is user input: bytes that are not UTF-8 are replaced, because they would make the file
    // unreadable.
    const nlohmann::json json = std::string(value);
    text.replace(start, token_end(text, start) - start,
                 json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

// Removes a member from the text with its comma: the one after it or, for the last member, the one before it.
void remove_member(std::string& text, const JsonDocument& document, std::string_view pointer) {
    std::size_t begin = document.offset(pointer, JsonPart::key),
                end = token_end(text, document.offset(pointer));
    const std::size_t next = skip_space(text, end);
    if (next < text.size() && text[next] == ',')
        end = skip_space(text, next + 1);
    else
        begin = text.find_last_of(',', begin);
    text.erase(begin, end - begin);
}

// JSON pointers of the template's model files: the assembly's own, then those of its tools.
std::vector<std::string> model_pointers(const std::string& text) {
    std::vector<std::string> pointers{"/model", "/model_far", "/contact_model", "/tool/model"};
    std::vector<Error> errors;
    const auto document = JsonDocument::parse(text, {}, errors);
    if (!document || !document->root().contains("more_tools")) return pointers;
    for (const auto& [name, tool] : document->root()["more_tools"].items())
        pointers.push_back((nlohmann::json::json_pointer("/more_tools") / name / "model").to_string());
    return pointers;
}

// Removes the members of missing model files from the text. Returns the template's own models, which must be
// copied; models of tools stay in the shared folder.
std::vector<fs::path> remove_missing_models(std::string& text) {
    std::vector<fs::path> copies;
    const fs::path content = content_folder(), template_folder = content / "assemblies" / template_name();
    for (const std::string& pointer : model_pointers(text)) {
        std::vector<Error> errors;
        const auto document = JsonDocument::parse(text, {}, errors);
        const nlohmann::json::json_pointer at(pointer);
        if (!document || !document->root().contains(at)) continue;
        const bool tool = pointer.find("tool") != std::string::npos;
        const fs::path file =
            (tool ? content / "tools" : template_folder) / document->root().at(at).get<std::string>();
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored))
            remove_member(text, *document, pointer);
        else if (!tool)
            copies.push_back(file);
    }
    return copies;
}

bool is_among_assemblies(const fs::path& folder) {
    const fs::path content = content_folder();
    std::error_code problem;
    return !content.empty() && fs::equivalent(fs::absolute(folder).lexically_normal().parent_path(),
                                              content / "assemblies", problem);
}

// The files and folders created so far. The destructor removes them unless commit() was called, so that a
// failure leaves no partial assembly.
class CreationRollback {
  public:
    CreationRollback() = default;
    CreationRollback(const CreationRollback&) = delete;
    CreationRollback& operator=(const CreationRollback&) = delete;
    ~CreationRollback() {
        std::error_code ignored;
        // fs::remove removes only empty folders, so files of others remain.
        for (auto path = paths_.rbegin(); path != paths_.rend(); ++path) fs::remove(*path, ignored);
    }

    Status folder(const fs::path& path) {
        std::error_code problem;
        std::vector<fs::path> missing;
        for (fs::path at = path; !at.empty() && !fs::exists(at, problem); at = at.parent_path())
            missing.push_back(at);
        paths_.insert(paths_.end(), missing.rbegin(), missing.rend());
        fs::create_directories(path, problem);
        if (problem)
            return path_error(path, ErrorCode::failed, "cannot be created: " + problem.message(), {});
        return {};
    }

    Status file(const fs::path& path, std::string_view text) {
        Status written = write_file(path, text);
        if (written) paths_.push_back(path);
        return written;
    }

    void commit() { paths_.clear(); }

  private:
    std::vector<fs::path> paths_;  // a folder precedes its contents
};

}  // namespace

Status create_assembly(const fs::path& folder, std::string_view name) {
    if (folder.empty() || name.empty())
        return fail(ErrorCode::usage, "no name for the assembly", "a folder and a name");
    std::error_code problem;
    if (fs::exists(folder, problem) && !fs::is_directory(folder, problem))
        return path_error(folder, ErrorCode::usage, "this is a file", "a folder that is new or empty");
    if (fs::is_directory(folder, problem) && !fs::is_empty(folder, problem))
        return path_error(folder, ErrorCode::usage, "this folder is not empty",
                          "a folder that is new or empty");
    // With a trailing slash filename() is empty.
    const fs::path target = folder.has_filename() ? folder : folder.parent_path();
    CreationRollback created;
    BOLT_TRY(created.folder(target));

    const bool inside = is_among_assemblies(target);
    std::string text(template_text());
    replace_value(text, "/$schema",
                  inside ? "../../schema/" + std::string(schema_name) : std::string(schema_name));
    for (const char* title : {"/title/en", "/title/de", "/title/zh"}) replace_value(text, title, name);
    for (const fs::path& model : remove_missing_models(text)) {
        BOLT_TRY_ASSIGN(const auto bytes, read_file(model, model_size_limit, ErrorCode::failed));
        BOLT_TRY(created.file(target / model.filename(), bytes));
    }
    BOLT_TRY(created.file(target / "assembly.json", text));
    if (!inside) BOLT_TRY(created.file(target / schema_name, assembly_schema_text()));
    created.commit();
    return {};
}

}  // namespace bolt::content
