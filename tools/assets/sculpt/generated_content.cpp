#include "tools/assets/sculpt/generated_content.hpp"

#include "engine/assets/gltf.hpp"
#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "tools/assets/sculpt/environment.hpp"
#include "tools/assets/sculpt/hand.hpp"

namespace bolt::sculpt {
namespace {

Result<std::filesystem::path> folder(const std::filesystem::path& content, const char* name) {
    std::filesystem::path path = content / name;
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (!error) return path;
    Error out;
    out.what = "cannot create the folder: " + error.message();
    out.expected = "a folder that this user may write to";
    out.file = path.string();
    return fail(out);
}

}  // namespace

Status write_hands(const std::filesystem::path& content) {
    const Result<std::filesystem::path> path = folder(content, "hands");
    if (!path) return tl::unexpected(path.error());
    const Result<HandModels> hands = make_hands();
    if (!hands) return tl::unexpected(hands.error());
    BOLT_TRY(assets::write_glb(*path / "hand_left.glb", hands->left));
    return assets::write_glb(*path / "hand_right.glb", hands->right);
}

Status write_workshop(const std::filesystem::path& content) {
    const Result<std::filesystem::path> path = folder(content, "environments");
    if (!path) return tl::unexpected(path.error());
    const Result<assets::Model> model = make_workshop();
    if (!model) return tl::unexpected(model.error());
    return assets::write_glb(*path / "workshop.glb", *model);
}

Status write_environment(const std::filesystem::path& content) {
    const Result<std::filesystem::path> path = folder(content, "environments");
    if (!path) return tl::unexpected(path.error());
    return write_file(*path / "workshop.hdr", assets::encode_hdr(workshop_panorama(512)));
}

}  // namespace bolt::sculpt
