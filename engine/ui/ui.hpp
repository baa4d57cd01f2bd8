// The user interface: Dear ImGui, drawn as an overlay. Between begin() and end() the caller uses
// <imgui/imgui.h> in this Ui's context. Several Uis may exist if each is ended before the next begins.
// Lengths are pixels: multiply points by scale(). Text is rasterised at its displayed size.
#pragma once

#include <imgui/imgui.h>

#include <memory>
#include <set>

#include "engine/gpu/frames.hpp"
#include "engine/render/overlay.hpp"
#include "engine/ui/input.hpp"

namespace bolt::ui {

struct UiOptions {
    float text_size = 14.0F;     // em size, points
    float heading_size = 24.0F;  // the same for heading_font()
};

class Ui {
  public:
    static Result<std::unique_ptr<Ui>> create(gpu::Device& device, const UiOptions& options = {});

    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;
    ~Ui();

    // Adds characters beyond the European ones to the font. Characters that were not added are drawn as
    // U+FFFD.
    void add_characters(std::string_view utf8);

    // Starts the interface's frame. `frame`: the GPU frame that will draw it.
    Status begin(gpu::FrameContext& frame, const UiInput& input);

    // Registers a picture of the renderer for ImGui::Image; the id is valid until end().
    ImTextureID picture(const render::ImageLayer& picture);

    // Returns the overlay for Renderer::draw_over. It refers to this Ui's font.
    render::Overlay end();

    [[nodiscard]] float scale() const { return scale_; }
    // A larger font with the same characters, for ImGui::PushFont between begin() and end().
    [[nodiscard]] ImFont* heading_font() const { return heading_font_; }
    // Return whether pointer and keyboard input is for the interface now, not for the scene.
    [[nodiscard]] bool wants_pointer() const;
    [[nodiscard]] bool wants_keys() const;
    // Returns whether the user moves through the controls with keys: Enter then presses the marked control.
    [[nodiscard]] bool navigates_by_keys() const;
    [[nodiscard]] bool edits_text() const;  // a text field has the keyboard focus

  private:
    Ui() = default;
    Status rebuild_font(gpu::FrameContext& frame);
    ImFont* add_font(float text_size, const ImWchar* ranges);

    struct Destroy {
        void operator()(ImGuiContext* context) const { ImGui::DestroyContext(context); }
    };
    struct Font {
        std::string file;
        float line = 1.0F;  // em between the lowest and the highest point, ImGui's definition of a font size
    };

    gpu::Device* device_ = nullptr;
    UiOptions options_;
    std::unique_ptr<ImGuiContext, Destroy> context_;
    std::vector<Font> fonts_;
    std::set<char32_t> characters_;
    bool stale_ = true;  // the font image lacks characters or has the wrong size
    float scale_ = 0.0F;
    ImFont* heading_font_ = nullptr;
    gpu::Image font_image_;
    std::vector<render::OverlayTexture> pictures_;  // in this frame
};

}  // namespace bolt::ui
