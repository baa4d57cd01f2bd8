#include "game/view/wall_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "content/displays/test_pattern.hpp"

namespace bolt::view {

namespace {

constexpr float text_points = 14.0F;

ImU32 color_of(content::PatternPart part) {
    switch (part) {
        case content::PatternPart::border:
            return IM_COL32(255, 255, 255, 255);
        case content::PatternPart::diagonal:
            return IM_COL32(90, 90, 90, 255);
        case content::PatternPart::cross:
            return IM_COL32(170, 170, 170, 255);
        case content::PatternPart::scale:
            return IM_COL32(255, 210, 60, 255);
        case content::PatternPart::frame_marks:
            return IM_COL32(110, 110, 110, 255);
        case content::PatternPart::present_mark:
            return IM_COL32(90, 230, 120, 255);
    }
    return IM_COL32_WHITE;
}

content::PatternEye eye_of(std::size_t eye, std::size_t count) {
    if (count == 1) return content::PatternEye::both;
    return eye == 0 ? content::PatternEye::left : content::PatternEye::right;
}

// Converts points of a wall (m, right and up from its lower left corner) to its picture (px, right and down).
struct PatternPicture {
    glm::dvec2 pixels_per_meter{0.0};
    double height = 0.0;  // px

    [[nodiscard]] ImVec2 at(const glm::dvec2& point) const {
        return {static_cast<float>(point.x * pixels_per_meter.x),
                static_cast<float>(height - point.y * pixels_per_meter.y)};
    }
};

void add_pattern(const content::TestPattern& pattern, const PatternPicture& picture, float text_size) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto right = static_cast<float>(list.GetClipRectMax().x) - 1.0F,
               bottom = static_cast<float>(list.GetClipRectMax().y) - 1.0F;
    // Moves lines on the edge of the picture inside it.
    const auto inside = [&](const ImVec2& at) {
        return ImVec2(std::clamp(at.x, 1.0F, right), std::clamp(at.y, 1.0F, bottom));
    };
    for (const content::PatternLine& line : pattern.lines)
        list.AddLine(inside(picture.at(line.from)), inside(picture.at(line.to)), color_of(line.part),
                     line.part == content::PatternPart::diagonal ? 1.0F : 2.0F);
    for (const content::PatternText& text : pattern.texts) {
        const ImVec2 middle = picture.at(text.center),
                     size = ImGui::GetFont()->CalcTextSizeA(text_size, 1e6F, 0.0F, text.text.c_str());
        list.AddText(ImGui::GetFont(), text_size, {middle.x - 0.5F * size.x, middle.y - 0.5F * size.y},
                     IM_COL32_WHITE, text.text.c_str());
    }
}

// Black, in the size of the group's pictures.
Status draw_black(gpu::FrameContext& frame, render::Renderer& renderer, const EyeGroup& group,
                  std::uint32_t index) {
    static const render::Scene black = [] {
        render::Scene scene;
        scene.background = {0.0F, 0.0F, 0.0F, 1.0F};
        return scene;
    }();
    return renderer.render(frame, black, group.eyes, group.size, index);
}

}  // namespace

Status WallPattern::start(GpuContext& gpu_context) {
    gpu_ = std::make_unique<GpuResources>();
    gpu_->context = &gpu_context;
    for (std::size_t i = 0; i <= displays_.walls.size(); ++i) {
        BOLT_TRY_ASSIGN(auto ui, ui::Ui::create(*gpu_context.device, {text_points}));
        if (i < displays_.walls.size()) ui->add_characters(displays_.walls[i].name);
        gpu_->uis.push_back(std::move(ui));
    }
    return {};
}

void WallPattern::release() {
    if (gpu_ && gpu_->context->device) (void)gpu_->context->device->idle();
    gpu_.reset();
}

Status WallPattern::update(const WindowFrame& window) {
    for (const platform::InputEvent& event : window.events) {
        const auto* key = std::get_if<platform::KeyEvent>(&event);
        closed_ = closed_ || std::holds_alternative<platform::CloseEvent>(event) ||
                  (key != nullptr && key->down && key->key == platform::Key::escape);
    }
    if (!follows_) ++frame_number_;
    return {};
}

Status WallPattern::share(cluster::MessageWriter& message, cluster::MessageWriter& /*bulk*/) {
    message.put(frame_number_);
    return {};
}

Status WallPattern::follow(cluster::MessageReader& message, cluster::MessageReader& /*bulk*/) {
    follows_ = true;
    frame_number_ = message.get<std::uint64_t>();
    return {};
}

Status WallPattern::draw_wall(gpu::FrameContext& frame, std::size_t wall, const EyeGroup& group) {
    const auto index = immersive_group + static_cast<std::uint32_t>(wall);
    render::Renderer& renderer = *gpu_->context->renderer;
    BOLT_TRY(draw_black(frame, renderer, group, index));
    const content::Wall& of_wall = displays_.walls[wall];
    const glm::dvec2 size(group.size.width, group.size.height),
        meters(content::width(of_wall), content::height(of_wall));
    for (std::size_t eye = 0; eye < group.eyes.size(); ++eye) {
        const content::TestPattern pattern =
            content::test_pattern(of_wall, eye_of(eye, group.eyes.size()), frame_number_);
        const PatternPicture picture{size / meters, size.y};
        // Pictures that a projector stretches have few pixels in one direction; the text fits into both.
        const double text_height = pattern.texts.empty()
                                       ? 0.0
                                       : pattern.texts.front().height *
                                             std::min(picture.pixels_per_meter.x, picture.pixels_per_meter.y);
        const auto text_size = static_cast<float>(std::max(std::round(text_height), 8.0));
        ui::UiInput input;
        input.size = glm::vec2(size);
        input.scale = text_size / text_points;
        BOLT_TRY(gpu_->uis[wall]->begin(frame, input));
        add_pattern(pattern, picture, text_size);
        const render::Overlay overlay = gpu_->uis[wall]->end();
        BOLT_TRY(
            renderer.draw_over(frame, overlay, renderer.picture(static_cast<std::uint32_t>(eye), index)));
    }
    return {};
}

Status WallPattern::draw_window(gpu::FrameContext& frame, const WindowFrame& window) {
    render::Renderer& renderer = *gpu_->context->renderer;
    const render::Eye eye;
    BOLT_TRY(draw_black(frame, renderer, {window.size, {eye}}, 0));
    ui::UiInput input;
    input.size = {static_cast<float>(window.size.width), static_cast<float>(window.size.height)};
    input.scale = window.scale;
    BOLT_TRY(gpu_->uis.back()->begin(frame, input));
    const Vec3& head = window.immersive->head.position;
    const std::string text =
        fmt::format("Head {:.3f} {:.3f} {:.3f} m, {}\nFrame {}\nEscape ends", head.x, head.y, head.z,
                    window.immersive->tracked ? "tracked" : "not tracked", frame_number_);
    ImGui::GetBackgroundDrawList()->AddText({10.0F * window.scale, 10.0F * window.scale}, IM_COL32_WHITE,
                                            text.c_str());
    const render::Overlay overlay = gpu_->uis.back()->end();
    return renderer.draw_over(frame, overlay, renderer.picture(0));
}

Status WallPattern::draw(gpu::FrameContext& frame, const WindowFrame& window) {
    if (window.immersive == nullptr) return {};
    for (std::size_t wall = 0; wall < window.immersive->groups.size(); ++wall)
        if (!window.immersive->groups[wall].eyes.empty())
            BOLT_TRY(draw_wall(frame, wall, window.immersive->groups[wall]));
    return window.size.width > 0 && window.size.height > 0 ? draw_window(frame, window) : Status{};
}

}  // namespace bolt::view
