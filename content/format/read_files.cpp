#include <fmt/format.h>

#include <algorithm>

#include "content/format/read_assembly.hpp"
#include "content/format/wording.hpp"

namespace bolt::content {

namespace fs = std::filesystem;

namespace {

// Names of the .glb files in a folder.
std::vector<std::string> models_in(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem))
        if (entry->path().extension() == ".glb") names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

bool lies_in(const fs::path& inner, const fs::path& folder) {
    std::error_code problem;
    const fs::path whole = fs::weakly_canonical(fs::absolute(inner), problem);
    return !problem &&
           std::mismatch(folder.begin(), folder.end(), whole.begin(), whole.end()).first == folder.end();
}

// The path that a value names, from `folder`. Whether it is there is only asked where `root` is known.
std::string read_file_name(Reader& reader, const Node& node, const fs::path& folder, const fs::path& root,
                           std::string_view where) {
    const auto name = reader.text(node);
    if (!name) return {};
    const fs::path given(*name);
    if (given.is_absolute() || name->find('\\') != std::string::npos ||
        name->find(':') != std::string::npos) {
        reader.report(node.pointer, fmt::format("{} is not a relative path", in_quotes(*name)),
                      fmt::format("expected a path from {}, with / between folders", where));
        return {};
    }
    if (given.extension() != ".glb") {
        reader.report(node.pointer, fmt::format("{} is no .glb file", in_quotes(*name)),
                      "expected a binary glTF file: bolt-author import-step makes one from STEP");
        return {};
    }
    fs::path path = (folder / given).lexically_normal();
    if (root.empty()) return path.string();
    if (!lies_in(path, root)) {
        const bool own = lies_in(root, fs::weakly_canonical(fs::absolute(folder)));
        reader.report(node.pointer,
                      fmt::format("{} leads out of {}", in_quotes(*name), own ? where : "the content folder"),
                      fmt::format("expected a file in {}", own ? where : "the content folder"));
        return {};
    }
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) {
        const std::vector<std::string> known = models_in(path.parent_path());
        reader.report(
            node.pointer, fmt::format("there is no file {} in {}", in_quotes(*name), where),
            known.empty() ? "expected a file; no .glb is there" : suggest(given.filename().string(), known));
        return {};
    }
    return path.string();
}

}  // namespace

ModelFiles read_model_files(Reader& reader, const FilePlaces& places) {
    const auto read = [&](std::string_view key) {
        return read_file_name(reader, reader.member(reader.root(), key), places.folder, places.root,
                              "the assembly's folder");
    };
    return {read("model"), read("model_far"), read("contact_model")};
}

std::string read_tool_model(Reader& reader, const Node& tool, const FilePlaces& places) {
    // Tools are shared by all assemblies, so their models lie in one place.
    const Node node = reader.member(tool, "model");
    const fs::path root = places.root.empty() ? fs::path{} : fs::weakly_canonical(places.tools);
    return read_file_name(reader, node, places.tools, root, "content/tools");
}

}  // namespace bolt::content
