#include "engine/render/hot_shaders.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>
#include <sstream>

#include "engine/base/file.hpp"
#include "engine/base/process.hpp"

std::span<const std::uint32_t> scene_shaders(std::string_view name);

namespace bolt::render {

namespace fs = std::filesystem;

namespace {

constexpr const char* compiler = "glslangValidator";
constexpr std::size_t max_file_size = std::size_t{64} << 20;

// Parses the file names after the colon of a make rule; a backslash escapes a space in a name.
std::set<fs::path> files_of_rule(const std::string& rule) {
    std::set<fs::path> files;
    std::string name;
    for (std::size_t i = rule.find(": ") + 1; i < rule.size(); ++i) {
        const bool escaped = rule[i] == '\\' && i + 1 < rule.size() && rule[i + 1] == ' ';
        if (escaped) ++i;
        if (escaped || (rule[i] != ' ' && rule[i] != '\n')) {
            name += rule[i];
        } else if (!name.empty()) {
            files.insert(std::exchange(name, {}));
        }
    }
    if (!name.empty()) files.insert(name);
    return files;
}

}  // namespace

Result<gpu::Shader> load_shader(const std::string& name, const ShaderCode& replacements) {
    Result<gpu::Shader> built_in = gpu::make_shader(name, scene_shaders(name));
    const auto replacement = replacements.find(name);
    if (!built_in || replacement == replacements.end()) return built_in;
    BOLT_TRY_ASSIGN(auto shader, gpu::make_shader(name, replacement->second));
    std::vector<gpu::Binding>& bindings = shader.reflection.bindings;
    for (const gpu::Binding& built_in_binding : built_in->reflection.bindings) {
        const bool declared = std::any_of(bindings.begin(), bindings.end(), [&](const gpu::Binding& binding) {
            return binding.set == built_in_binding.set && binding.binding == built_in_binding.binding;
        });
        if (!declared) bindings.push_back(built_in_binding);
    }
    return shader;
}

Result<HotShaders> HotShaders::open(const fs::path& path) {
    std::error_code problem;
    const fs::path folder = fs::canonical(path, problem);
    if (problem || !fs::is_directory(folder))
        return fail(ErrorCode::usage, fmt::format("{} does not exist", path.string()),
                    "a folder with shaders");
    if (folder.filename() != "shaders")
        return fail(ErrorCode::usage, fmt::format("{} is not named \"shaders\"", path.string()),
                    "a folder with that name, because the files include each other by it");
    HotShaders hot;
    hot.folder_ = folder;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, problem)) {
        std::string name = entry.path().filename().string();
        if (!scene_shaders(name).empty()) hot.pending_.insert(std::move(name));
    }
    if (hot.pending_.empty())
        return fail(ErrorCode::usage,
                    fmt::format("{} contains none of the renderer's shaders", path.string()),
                    "scene.vert, scene.frag and the others");
    if (const auto found = run_program({compiler, "--version"}, Capture::output_and_errors); !found)
        return fail(ErrorCode::failed, found.error().what, "the package glslang-tools");
    std::string pattern = (fs::temp_directory_path() / "boltwright-shaders-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr)
        return fail(ErrorCode::failed,
                    fmt::format("the folder for the compiler's output cannot be created: {}", pattern),
                    "a writable folder for temporary files");
    hot.output_folder_ = pattern;
    hot.watch();
    return hot;
}

HotShaders& HotShaders::operator=(HotShaders&& other) noexcept {
    std::swap(folder_, other.folder_);
    std::swap(output_folder_, other.output_folder_);
    std::swap(code_, other.code_);
    std::swap(sources_, other.sources_);
    std::swap(pending_, other.pending_);
    std::swap(watch_, other.watch_);
    return *this;
}

HotShaders::~HotShaders() {
    std::error_code ignored;
    if (!output_folder_.empty()) fs::remove_all(output_folder_, ignored);
}

// Watches the files of the folder, and included files outside of it.
void HotShaders::watch() {
    std::vector<fs::path> files;
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder_, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem))
        files.push_back(entry->path());
    for (const auto& [name, sources] : sources_) files.insert(files.end(), sources.begin(), sources.end());
    watch_.watch(std::move(files));
}

Status HotShaders::compile(const std::string& name) {
    const fs::path spirv = output_folder_ / (name + ".spv"), rule = output_folder_ / (name + ".d");
    std::vector<std::string> command{compiler};
    std::istringstream flags(BOLT_GLSL_FLAGS);  // the same flags as in the build
    for (std::string flag; flags >> flag;) command.push_back(flag);
    for (const std::string& word :
         {"-I" + folder_.parent_path().string(), std::string("--depfile"), rule.string(), std::string("-o"),
          spirv.string(), (folder_ / name).string()})
        command.push_back(word);
    BOLT_TRY_ASSIGN(const auto run, run_program(command, Capture::output_and_errors));
    if (run.exit_code != 0) return fail(ErrorCode::bad_content, run.output, "a shader without mistakes");
    BOLT_TRY_ASSIGN(const auto bytes, read_file(spirv, max_file_size, ErrorCode::failed));
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    code_[name] = std::move(words);
    BOLT_TRY_ASSIGN(const auto rule_text, read_file(rule, max_file_size, ErrorCode::failed));
    sources_[name] = files_of_rule(rule_text);
    sources_[name].insert(folder_ / name);
    return {};
}

std::optional<Result<ShaderCode>> HotShaders::changed(double now) {
    const bool first = code_.empty() && !pending_.empty() && sources_.empty();
    const std::vector<fs::path> files = watch_.changed(now);
    if (files.empty() && !first) return {};
    for (const auto& [name, sources] : sources_)
        if (std::any_of(files.begin(), files.end(),
                        [&used = sources](const fs::path& file) { return used.contains(file); }))
            pending_.insert(name);
    std::string output;
    std::set<std::string> failed;
    for (const std::string& name : pending_) {
        const Status compiled = compile(name);
        if (compiled) continue;
        failed.insert(name);
        sources_[name].insert(folder_ / name);
        output += compiled.error().what;
    }
    pending_ = std::move(failed);
    watch();
    if (pending_.empty()) return Result<ShaderCode>(code_);
    while (!output.empty() && output.back() == '\n') output.pop_back();
    return Result<ShaderCode>(fail(
        ErrorCode::bad_content,
        fmt::format("{} shaders do not compile: {}\n{}", pending_.size(), fmt::join(pending_, ", "), output),
        "shaders without mistakes"));
}

}  // namespace bolt::render
