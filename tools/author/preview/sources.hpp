// What the preview shows, as it is on the disk now.
#pragma once

#include "engine/base/file_watch.hpp"
#include "game/view/loaded_model.hpp"
#include "tools/author/preview/options.hpp"

namespace bolt::author {

class Sources {
  public:
    explicit Sources(const PreviewOptions& options) : what_(options.what), light_(options.light) {}

    // What the files hold now; `keep` makes it what is shown.
    [[nodiscard]] view::LoadedSubject read_subject(view::Level level) const {
        return view::load_subject(what_, level);
    }
    [[nodiscard]] Result<shading::RadianceImage> read_light() const { return view::load_light(light_); }
    void keep(view::Subject subject, view::Level level);
    void keep(shading::RadianceImage radiance) { radiance_ = std::move(radiance); }

    struct Changes {
        bool subject = false, light = false;
    };
    // On the disk, since the last call. `now` as FileWatch has it.
    Changes changed(double now);

    [[nodiscard]] const view::Subject& subject() const { return subject_; }
    [[nodiscard]] const shading::RadianceImage& radiance() const { return radiance_; }
    [[nodiscard]] view::Level level() const { return level_; }

  private:
    std::string what_, light_;
    view::Level level_ = view::Level::near;
    view::Subject subject_;
    shading::RadianceImage radiance_;
    FileWatch watch_;
};

}  // namespace bolt::author
