// The user interface: Dear ImGui, drawn as an overlay. Between begin and end the caller uses <imgui/imgui.h>
// in this Ui's context; several live side by side as long as one is ended before the next begins. Lengths are
// pixels: what is designed in points is multiplied by scale(). Text is rasterised at the size at which it is
// shown.
#pragma once

#include <imgui/imgui.h>

#include <memory>
#include <set>

#include "engine/gpu/frames.hpp"
#include "engine/render/overlay.hpp"
#include "engine/ui/input.hpp"

namespace bolt::ui {

struct UiOptions {
    float text_size = 14.0F;  // of an em, points
};

class Ui {
  public:
    static Result<std::unique_ptr<Ui>> create(gpu::Device& device, const UiOptions& options = {});

    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;
    ~Ui();

    // Letters beyond those of European languages that will be written. Unknown ones are drawn as "?".
    void need(std::string_view utf8);

    // `frame` is the one that will draw it.
    Status begin(gpu::Frame& frame, const Input& input);

    // A picture of the renderer's, for ImGui::Image. Until end.
    ImTextureID picture(const render::Layer& picture);

    // What Renderer::draw_over takes. Refers to this Ui's font.
    render::Overlay end();

    [[nodiscard]] float scale() const { return scale_; }
    // Whether pointer and keys belong to the interface now, not to what is behind it.
    [[nodiscard]] bool wants_pointer() const;
    [[nodiscard]] bool wants_keys() const;

  private:
    Ui() = default;
    Status rebuild(gpu::Frame& frame);

    struct Destroy {
        void operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }
    };
    struct Font {
        std::string file;
        float line = 1.0F;  // em from the lowest to the highest: what ImGui means by a font's size
    };

    gpu::Device* device_ = nullptr;
    UiOptions options_;
    std::unique_ptr<ImGuiContext, Destroy> context_;
    std::vector<Font> fonts_;
    std::set<char32_t> letters_;
    bool stale_ = true;  // the font has not all letters, or not the right size
    float scale_ = 0.0F;
    gpu::Image font_image_;
    std::vector<render::OverlayTexture> pictures_;  // of this frame
};

}  // namespace bolt::ui
