// What bolt-author preview is asked for.
#pragma once

#include <string>

#include "engine/base/file.hpp"
#include "engine/gpu/vk.hpp"
#include "engine/platform/window.hpp"
#include "game/view/loaded_model.hpp"

namespace bolt::author {

struct PreviewOptions {
    std::string what;              // assembly or model
    std::string view;              // its first view; empty: all of it
    std::string light = "studio";  // or a Radiance file
    std::string shaders;           // a folder to take them from; empty: those built in
    std::string gpu;               // part of a name
    std::string png;               // no window: one picture
    VkExtent2D size{1280, 720};
    bool validate = false;
};

// What the preview shows, as it is on the disk now.

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

// The preview itself: draws in a window until it is closed, and follows the files.

// A GPU that is lost is started again, once in a while (gpu::DeviceLossPolicy).
Status show_preview(const PreviewOptions& options, Sources& sources, platform::Window& window,
                    const gpu::Instance& instance);

// One picture without a window.
Status draw_preview(const PreviewOptions& options, const Sources& sources, const gpu::Instance& instance);

}  // namespace bolt::author
