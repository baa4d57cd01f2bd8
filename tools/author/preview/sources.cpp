#include "tools/author/preview/sources.hpp"

namespace bolt::author {

void Sources::keep(view::Subject subject, view::Level level) {
    subject_ = std::move(subject);
    level_ = level;
    std::vector<std::filesystem::path> files = subject_.files;
    files.emplace_back(light_);  // "studio" is no file, and none that comes
    watch_.watch(std::move(files));
}

Sources::Changes Sources::changed(double now) {
    Changes changes;
    for (const std::filesystem::path& file : watch_.changed(now)) {
        if (file == light_)
            changes.light = true;
        else
            changes.subject = true;
    }
    return changes;
}

}  // namespace bolt::author
