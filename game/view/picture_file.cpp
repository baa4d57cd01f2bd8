#include "game/view/picture_file.hpp"

#include "engine/assets/image.hpp"
#include "engine/base/console.hpp"
#include "engine/base/file.hpp"

namespace bolt::view {

Status write_picture(const render::Picture& picture, const std::filesystem::path& file) {
    BOLT_TRY_ASSIGN(const auto png, assets::encode_png(static_cast<int>(picture.width),
                                                       static_cast<int>(picture.height), 4, picture.rgba));
    std::error_code ignored;  // write_file says why
    if (const auto folder = file.parent_path(); !folder.empty())
        std::filesystem::create_directories(folder, ignored);
    BOLT_TRY(write_file(file, png));
    return print(file.string() + "\n");
}

}  // namespace bolt::view
