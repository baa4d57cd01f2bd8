#include "game/view/palette.hpp"

namespace bolt::view {

using lesson::Verdict;

Palette palette_of(content::PaletteKind kind) {
    Palette palette;
    if (kind == content::PaletteKind::usual) return palette;
    palette.due = {0.94F, 0.89F, 0.26F, 1.0F};
    palette.low = {0.92F, 0.92F, 0.95F, 1.0F};
    palette.ok = palette.right = {0.2F, 0.6F, 1.0F, 1.0F};
    palette.high = palette.wrong = {0.9F, 0.35F, 0.0F, 1.0F};
    return palette;
}

Verdict verdict_of(const lesson::JointResult& joint) {
    return joint.condition != joint::Condition::sound ? Verdict::high : joint.overall;
}

glm::vec4 color_of(const Palette& palette, Verdict verdict) {
    switch (verdict) {
        case Verdict::low:
            return palette.low;
        case Verdict::ok:
            return palette.ok;
        case Verdict::high:
            return palette.high;
        default:
            return glm::vec4(0.0F);
    }
}

std::string_view sign_of(Verdict verdict) {
    switch (verdict) {
        case Verdict::low:
            return "▼";
        case Verdict::ok:
            return "●";
        case Verdict::high:
            return "▲";
        default:
            return "";
    }
}

}  // namespace bolt::view
