#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "content/format/json_document.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/geometry/messages.hpp"

namespace bolt::geometry {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// The member of an object; an empty value if there is none.
const json& member(const json& object, const char* key) {
    static const json none;
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found == object.end() ? none : *found;
}

// Reports each picture in the passes of `holder`, the file or one of its variants, that lessons cannot show.
void check_pictures(const json& holder, const std::string& at, const fs::path& folder,
                    const Messages& messages) {
    for (const char* list : {"passes", "loosening"}) {
        const json& passes = member(holder, list);
        for (std::size_t i = 0; passes.is_array() && i < passes.size(); ++i) {
            const json& picture = member(member(passes[i], "instruction"), "picture");
            if (!picture.is_string()) continue;
            const auto bytes = read_file(folder / picture.get<std::string>(), content::largest_picture_file,
                                         ErrorCode::bad_content);
            assets::Bitmap bitmap;
            if (bytes) bitmap.encoded.assign(bytes->begin(), bytes->end());
            const Status decoded = bytes ? assets::decode(bitmap) : Status(fail(bytes.error()));
            if (decoded) continue;
            messages.error(fmt::format("{}/{}/{}/instruction/picture", at, list, i),
                           fmt::format("the picture {} cannot be shown: {}",
                                       content::in_quotes(picture.get<std::string>()), decoded.error().what),
                           "a PNG or JPEG file of at most 32 MiB");
        }
    }
}

void note_unused_types(const json& root, const Messages& messages) {
    std::set<std::string> used;
    for (const json& joint : member(root, "joints"))
        if (const json& type = member(joint, "type"); type.is_string()) used.insert(type.get<std::string>());
    for (const auto& [name, type] : member(root, "joint_types").items())
        if (!used.contains(name))
            messages.note("/joint_types/" + content::pointer_token(name),
                          fmt::format("no joint has the type {}", content::in_quotes(name)));
}

}  // namespace

Findings check_references(const content::Assembly& assembly) {
    Findings findings;
    const auto document = content::JsonDocument::parse(assembly.text, assembly.file, findings.errors);
    if (!document) return findings;
    const Messages messages{*document, findings};
    const fs::path folder = fs::path(assembly.file).parent_path();
    check_pictures(document->root(), "", folder, messages);
    for (const auto& [name, variant] : member(document->root(), "variants").items())
        check_pictures(variant, "/variants/" + content::pointer_token(name), folder, messages);
    note_unused_types(document->root(), messages);
    return findings;
}

}  // namespace bolt::geometry
