// The preview of an assembly or a model that reloads its files when they change.
#pragma once

#include <string>

#include "engine/base/file.hpp"
#include "engine/gpu/vk.hpp"
#include "engine/platform/window.hpp"
#include "game/view/loaded_model.hpp"

namespace bolt::author {

struct PreviewOptions {
    std::string source;            // assembly (folder, file or name) or model file
    std::string variant;           // of the assembly; empty: its default one
    std::string view;              // name of the first view; empty: the whole model
    std::string light = "studio";  // or a Radiance file
    std::string shaders;           // folder with GLSL; empty: the built-in shaders
    std::string gpu;               // part of the name of a GPU
    std::string png;               // file for one picture without a window; empty: a window
    VkExtent2D size{1280, 720};
    bool validate = false;
};

// The model and the light that the preview shows, and the watch on their files.
class PreviewSources {
  public:
    explicit PreviewSources(const PreviewOptions& options)
        : source_(options.source), light_(options.light), variant_(options.variant) {}

    // Reload the files. set_shown() makes the result current.
    [[nodiscard]] view::ModelLoadResult read_model(view::DetailLevel level,
                                                   const std::string& variant) const {
        return view::load_model(source_, level, variant);
    }
    [[nodiscard]] Result<shading::RadianceImage> read_light() const { return view::load_light(light_); }
    void set_shown(view::LoadedModel model, view::DetailLevel level, std::string variant);
    void set_shown(shading::RadianceImage radiance) { radiance_ = std::move(radiance); }

    struct FileChanges {
        bool model = false, light = false;
    };
    // Returns the files that changed since the last call. `now`: s, as for FileWatch.
    FileChanges poll_changes(double now);

    [[nodiscard]] const view::LoadedModel& model() const { return model_; }
    [[nodiscard]] const shading::RadianceImage& radiance() const { return radiance_; }
    [[nodiscard]] view::DetailLevel level() const { return level_; }
    [[nodiscard]] const std::string& variant() const { return variant_; }  // empty: the default one

  private:
    std::string source_, light_, variant_;
    view::DetailLevel level_ = view::DetailLevel::near;
    view::LoadedModel model_;
    shading::RadianceImage radiance_;
    FileWatch watch_;
};

// Draws in the window until it is closed and reloads changed files. Restarts after a lost GPU as
// gpu::DeviceLossPolicy allows.
Status show_preview(const PreviewOptions& options, PreviewSources& sources, platform::Window& window,
                    const gpu::Instance& instance);

// Draws one picture without a window into options.png.
Status draw_preview(const PreviewOptions& options, const PreviewSources& sources,
                    const gpu::Instance& instance);

}  // namespace bolt::author
