#include "engine/render/label_batch.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "engine/text/layout.hpp"

namespace bolt::render {

namespace {

// Decodes an sRGB component (IEC 61966-2-1).
float linear(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

// Alpha is not encoded.
glm::vec4 linear(const glm::vec4& encoded) {
    return {linear(encoded.r), linear(encoded.g), linear(encoded.b), encoded.a};
}

static_assert(sizeof(shared::LabelFrame) == 64 && sizeof(shared::LabelQuad) == 64);
static_assert(offsetof(shared::LabelQuad, grow) == 48);

// Margin of the background around the text, em.
constexpr glm::vec2 margin(0.35F, 0.15F);
constexpr float corner = 0.3F;

shared::LabelFrame frame_of(const Label& label) {
    shared::LabelFrame frame{};
    const float stand = label.stand == LabelPlacement::fixed    ? LABEL_FIXED
                        : label.stand == LabelPlacement::facing ? LABEL_FACING
                                                                : LABEL_ON_SCREEN;
    frame.position = glm::vec4(label.position, label.height);
    frame.right = glm::vec4(label.turn * glm::vec3(1, 0, 0), stand);
    frame.up = glm::vec4(label.turn * glm::vec3(0, 1, 0), std::clamp(label.through, 0.0F, 1.0F));
    frame.pixels = glm::vec4(label.moved_px, label.before, 0.0F);
    return frame;
}

shared::LabelQuad plate_of(const Label& label, const glm::vec2& low, const glm::vec2& size) {
    shared::LabelQuad quad{};
    const glm::vec2 half = 0.5F * size + margin, middle = low + 0.5F * size;
    // Enlarge the background slightly, because its edge is smoothed over one pixel.
    const glm::vec2 room = half + static_cast<float>(text::Atlas::reach);
    quad.rect = glm::vec4(middle - room, middle + room);
    quad.uv = glm::vec4(half, half);
    quad.color = linear(label.plate);
    quad.grow = corner;
    quad.plate = 1;
    return quad;
}

}  // namespace

std::optional<LabelBatch> make_label_batch(std::span<const Label> labels, const glm::mat4& clip_from_world,
                                           const text::Fonts& fonts, text::Atlas& atlas) {
    std::vector<std::size_t> order(labels.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto distance = [&](std::size_t i) {
        return (clip_from_world * glm::vec4(labels[i].position, 1.0F)).w;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) > distance(b); });
    LabelBatch batch;
    for (const std::size_t i : order) {
        const Label& label = labels[i];
        const text::TextLayout layout = text::lay_out(fonts, label.text, label.anchor.x);
        if (layout.glyphs.empty()) continue;
        const glm::vec2 low = -label.anchor * layout.size;
        const auto add = [&](shared::LabelQuad quad) {
            quad.label = static_cast<std::uint32_t>(batch.labels.size());
            batch.quads.push_back(quad);
        };
        if (label.plate.a > 0.0F) add(plate_of(label, low, layout.size));
        const auto add_glyphs = [&](const glm::vec4& color, float grow) {
            for (const text::PlacedGlyph& placed : layout.glyphs) {
                const text::AtlasGlyph* glyph = atlas.glyph(fonts, placed.id);
                if (glyph == nullptr) return false;
                if (glyph->low == glyph->high) continue;
                const glm::vec2 at = low + placed.at;
                shared::LabelQuad quad{};
                quad.rect = glm::vec4(at + glyph->low, at + glyph->high);
                quad.uv = glm::vec4(glyph->uv_low, glyph->uv_high);
                quad.color = linear(color);
                quad.grow = grow;
                add(quad);
            }
            return true;
        };
        // Draw all outlines first, so that a glyph's outline does not cover the previous glyph.
        if (label.outline.a > 0.0F && !add_glyphs(label.outline, std::clamp(label.outline_width, 0.0F, 0.1F)))
            return std::nullopt;
        if (!add_glyphs(label.color, 0.0F)) return std::nullopt;
        batch.labels.push_back(frame_of(label));
    }
    return batch;
}

}  // namespace bolt::render
