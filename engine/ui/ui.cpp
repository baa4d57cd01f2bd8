#include "engine/ui/ui.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/gpu/resources.hpp"
#include "engine/text/fonts.hpp"
#include "engine/text/layout.hpp"

namespace bolt::ui {

namespace {

// Returns the style of the user interface. Lengths are points times `scale`. Colours are blended linearly
// (see shaders/overlay.frag), so a bright background shines through a translucent colour more than it would
// with blending of encoded values.
ImGuiStyle make_style(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 6.0F;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4.0F;
    style.WindowPadding = {12.0F, 10.0F};
    style.FramePadding = {8.0F, 5.0F};
    style.ItemSpacing = {8.0F, 6.0F};
    style.WindowBorderSize = 0.0F;
    style.WindowTitleAlign = {0.5F, 0.5F};
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = {0.93F, 0.94F, 0.95F, 1.0F};
    c[ImGuiCol_TextDisabled] = {0.60F, 0.63F, 0.66F, 1.0F};
    c[ImGuiCol_WindowBg] = {0.10F, 0.12F, 0.14F, 0.975F};
    c[ImGuiCol_PopupBg] = {0.13F, 0.15F, 0.18F, 0.98F};
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgCollapsed] = {0.13F, 0.16F, 0.19F, 0.96F};
    c[ImGuiCol_TitleBgActive] = {0.16F, 0.22F, 0.28F, 0.98F};
    c[ImGuiCol_FrameBg] = {0.20F, 0.23F, 0.27F, 1.0F};
    c[ImGuiCol_FrameBgHovered] = {0.25F, 0.30F, 0.35F, 1.0F};
    c[ImGuiCol_FrameBgActive] = {0.28F, 0.36F, 0.43F, 1.0F};
    c[ImGuiCol_Button] = {0.20F, 0.34F, 0.46F, 1.0F};
    c[ImGuiCol_ButtonHovered] = {0.24F, 0.43F, 0.58F, 1.0F};
    c[ImGuiCol_ButtonActive] = {0.16F, 0.50F, 0.70F, 1.0F};
    c[ImGuiCol_Header] = {0.20F, 0.34F, 0.46F, 1.0F};
    c[ImGuiCol_HeaderHovered] = {0.24F, 0.43F, 0.58F, 1.0F};
    c[ImGuiCol_HeaderActive] = {0.16F, 0.50F, 0.70F, 1.0F};
    c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrabActive] = {0.45F, 0.80F, 1.00F, 1.0F};
    c[ImGuiCol_SliderGrab] = {0.35F, 0.62F, 0.80F, 1.0F};
    c[ImGuiCol_PlotHistogram] = {0.45F, 0.80F, 1.00F, 1.0F};
    style.ScaleAllSizes(scale);
    return style;
}

static_assert(IM_COL32_R_SHIFT == 0 && IM_COL32_A_SHIFT == 24);

// The characters that every font atlas has: those of European languages (ranges of code points, inclusive)
// and symbols used in bolting.
constexpr std::pair<char32_t, char32_t> default_ranges[] = {{0x20, 0x7E}, {0xA0, 0x17F}, {0x391, 0x3C9}};
constexpr std::u32string_view default_symbols = U"–—‘’‚“”„…•′″€⁰¹²³⁴⁻₀₁₂₃₄←↑→↓∆∑−√∞∠∥≈≠≤≥✓✗�";

// Texture 1 is the font; this frame's pictures follow.
ImTextureID texture_id(std::size_t number) {
    ImTextureID id = nullptr;
    static_assert(sizeof id == sizeof number);
    std::memcpy(&id, &number, sizeof id);
    return id;
}
std::size_t texture_number(ImTextureID id) {
    std::size_t number = 0;
    std::memcpy(&number, &id, sizeof number);
    return number;
}

// In the order of UiKey.
constexpr ImGuiKey imgui_keys[key_count] = {
    ImGuiKey_Tab,    ImGuiKey_LeftArrow, ImGuiKey_RightArrow, ImGuiKey_UpArrow, ImGuiKey_DownArrow,
    ImGuiKey_PageUp, ImGuiKey_PageDown,  ImGuiKey_Home,       ImGuiKey_End,     ImGuiKey_Insert,
    ImGuiKey_Delete, ImGuiKey_Backspace, ImGuiKey_Space,      ImGuiKey_Enter,   ImGuiKey_Escape,
    ImGuiKey_A,      ImGuiKey_C,         ImGuiKey_V,          ImGuiKey_X,       ImGuiKey_Y,
    ImGuiKey_Z};

void set_input(ImGuiIO& io, const UiInput& input) {
    io.DisplaySize = {input.size.x, input.size.y};
    io.DeltaTime = static_cast<float>(std::max(input.seconds, 1e-6));
    // A pointer outside the picture is placed where no widget can be.
    io.MousePos = input.pointer_inside
                      ? ImVec2(input.pointer.x, input.pointer.y)
                      : ImVec2(-std::numeric_limits<float>::max(), -std::numeric_limits<float>::max());
    const auto is_down = [](const UiButton& button) { return button.down || button.pressed; };
    std::transform(input.buttons.begin(), input.buttons.end(), io.MouseDown, is_down);
    io.MouseWheelH = input.wheel.x;
    io.MouseWheel = input.wheel.y;
    std::transform(input.keys.begin(), input.keys.end(), io.KeysDown, is_down);
    // ImGui presses the marked control with Space. People expect Enter to do so as well.
    bool& space = io.KeysDown[static_cast<std::size_t>(UiKey::space)];
    space =
        space || (io.KeysDown[static_cast<std::size_t>(UiKey::enter)] && io.NavVisible && !io.WantTextInput);
    io.KeyCtrl = input.ctrl;
    io.KeyShift = input.shift;
    io.KeyAlt = input.alt;
    io.AddInputCharactersUTF8(input.text.c_str());
}

VkRect2D scissor_of(const ImVec4& clip) {
    const auto left = static_cast<std::int32_t>(std::floor(std::max(clip.x, 0.0F))),
               top = static_cast<std::int32_t>(std::floor(std::max(clip.y, 0.0F)));
    const auto right = static_cast<std::int32_t>(std::ceil(clip.z)),
               bottom = static_cast<std::int32_t>(std::ceil(clip.w));
    return {{left, top},
            {static_cast<std::uint32_t>(std::max(right - left, 0)),
             static_cast<std::uint32_t>(std::max(bottom - top, 0))}};
}

void append(render::Overlay& overlay, const ImDrawList& list) {
    const std::size_t vertices = overlay.vertices.size(), indices = overlay.indices.size();
    for (const ImDrawVert& v : list.VtxBuffer)
        overlay.vertices.push_back({{v.pos.x, v.pos.y}, {v.uv.x, v.uv.y}, v.col});
    overlay.indices.insert(overlay.indices.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
    for (const ImDrawCmd& command : list.CmdBuffer) {
        render::OverlayDraw draw;
        draw.scissor = scissor_of(command.ClipRect);
        draw.texture = static_cast<int>(texture_number(command.GetTexID())) - 1;
        draw.first_index = static_cast<std::uint32_t>(indices) + command.IdxOffset;
        draw.count = command.ElemCount;
        draw.first_vertex = static_cast<std::int32_t>(vertices + command.VtxOffset);
        overlay.draws.push_back(draw);
    }
}

}  // namespace

Result<std::unique_ptr<Ui>> Ui::create(gpu::Device& device, const UiOptions& options) {
    std::unique_ptr<Ui> ui(new Ui);
    ui->device_ = &device;
    ui->options_ = options;
    for (const text::FontFile& font : text::font_files()) {
        BOLT_TRY_ASSIGN(auto file, text::find_font(font, text::font_folders()));
        BOLT_TRY_ASSIGN(auto face, text::FontFace::read(file));
        ui->fonts_.push_back({file.string(), face.ascent() + face.descent()});
    }
    for (const auto& [first, last] : default_ranges)
        for (char32_t point = first; point <= last; ++point) ui->characters_.insert(point);
    ui->characters_.insert(default_symbols.begin(), default_symbols.end());

    ImGuiContext* before = ImGui::GetCurrentContext();
    ui->context_.reset(ImGui::CreateContext());
    ImGui::SetCurrentContext(ui->context_.get());
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // no settings file
    io.LogFilename = nullptr;
    io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    for (std::size_t i = 0; i < key_count; ++i) io.KeyMap[imgui_keys[i]] = static_cast<int>(i);
    ImGui::SetCurrentContext(before);
    return ui;
}

Ui::~Ui() = default;

void Ui::add_characters(std::string_view utf8) {
    for (const char32_t point : text::decode(utf8))
        if (point >= 0x20 && point <= IM_UNICODE_CODEPOINT_MAX) stale_ |= characters_.insert(point).second;
}

// Merges all font files into one font of this size. Returns null if a file cannot be read.
ImFont* Ui::add_font(float text_size, const ImWchar* ranges) {
    ImFont* added = nullptr;
    for (const Font& font : fonts_) {
        ImFontConfig config;
        config.MergeMode = &font != &fonts_.front();
        // Chinese characters all have the same width and are aligned to whole pixels; others may be placed
        // between pixels.
        config.OversampleH = config.MergeMode ? 1 : 3;
        config.PixelSnapH = config.MergeMode;
        // ImGui 1.90 rounds sizes down.
        const float size = std::round(text_size * scale_ * font.line);
        added = ImGui::GetIO().Fonts->AddFontFromFileTTF(font.file.c_str(), size, &config, ranges);
        if (added == nullptr) return nullptr;
    }
    return added;
}

Status Ui::rebuild_font(gpu::FrameContext& frame) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    ImFontGlyphRangesBuilder builder;
    for (const char32_t point : characters_) builder.AddChar(static_cast<ImWchar>(point));
    ImVector<ImWchar> ranges;
    builder.BuildRanges(&ranges);
    if (add_font(options_.text_size, ranges.Data) == nullptr ||
        (heading_font_ = add_font(options_.heading_size, ranges.Data)) == nullptr)
        return fail(ErrorCode::failed, "the interface's fonts cannot be read", "the fonts of packages.txt");
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsAlpha8(&texels, &width, &height);
    if (texels == nullptr)
        return fail(ErrorCode::failed, "the interface's font cannot be rasterised",
                    "enough memory for its characters");
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R8_UNORM;
    info.extent = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.array = true;
    BOLT_TRY_ASSIGN(auto image, gpu::Image::create(*device_, info));
    const std::size_t size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    BOLT_TRY(gpu::upload_image(*device_, image, std::as_bytes(std::span(texels, size))));
    if (font_image_.get() != VK_NULL_HANDLE) frame.retire(std::move(font_image_));
    font_image_ = std::move(image);
    atlas.SetTexID(texture_id(1));
    atlas.ClearTexData();
    stale_ = false;
    return {};
}

Status Ui::begin(gpu::FrameContext& frame, const UiInput& input) {
    ImGui::SetCurrentContext(context_.get());
    if (const float scale = std::clamp(input.scale, 0.25F, 8.0F); scale != scale_) {
        scale_ = scale;
        ImGui::GetStyle() = make_style(scale);
        stale_ = true;
    }
    if (stale_) BOLT_TRY(rebuild_font(frame));
    pictures_.clear();
    set_input(ImGui::GetIO(), input);
    ImGui::NewFrame();
    return {};
}

ImTextureID Ui::picture(const render::ImageLayer& picture) {
    pictures_.push_back({picture, gpu::ResourceUse::transfer_from, false});
    return texture_id(pictures_.size() + 1);
}

render::Overlay Ui::end() {
    ImGui::Render();
    render::Overlay overlay;
    overlay.textures.push_back({{&font_image_, 0}, gpu::ResourceUse::sampled, true});
    overlay.textures.insert(overlay.textures.end(), pictures_.begin(), pictures_.end());
    const ImDrawData& data = *ImGui::GetDrawData();
    for (int i = 0; i < data.CmdListsCount; ++i) append(overlay, *data.CmdLists[i]);
    return overlay;
}

bool Ui::wants_pointer() const {
    ImGui::SetCurrentContext(context_.get());
    return ImGui::GetIO().WantCaptureMouse;
}

bool Ui::wants_keys() const {
    ImGui::SetCurrentContext(context_.get());
    return ImGui::GetIO().WantCaptureKeyboard;
}

bool Ui::navigates_by_keys() const {
    ImGui::SetCurrentContext(context_.get());
    return ImGui::GetIO().NavVisible && !ImGui::GetIO().WantTextInput;
}

bool Ui::edits_text() const {
    ImGui::SetCurrentContext(context_.get());
    return ImGui::GetIO().WantTextInput;
}

}  // namespace bolt::ui
