#include "engine/shading/ggx.hpp"

#include <array>

namespace bolt::shading {

namespace {

// The table has uniform steps in roughness and in √cosine, because the albedo varies most at grazing angles.
constexpr int table_size = 48;
constexpr unsigned directions = 256;

using AlbedoTable = std::array<glm::vec2, table_size * table_size>;

AlbedoTable make_table() {
    AlbedoTable table;
    for (int r = 0; r < table_size; ++r) {
        for (int c = 0; c < table_size; ++c) {
            const float roughness = static_cast<float>(r) / (table_size - 1);
            const float root = std::max(static_cast<float>(c) / (table_size - 1), 1e-3F);
            table[static_cast<std::size_t>(r * table_size + c)] =
                integrate_albedo(roughness * roughness, root * root, directions);
        }
    }
    return table;
}

}  // namespace

glm::vec2 integrate_albedo(float alpha, float cosine, unsigned count) {
    const glm::vec2 width(std::max(alpha, 1e-4F));
    const glm::vec3 out(std::sqrt(std::max(0.0F, 1.0F - cosine * cosine)), 0.0F, cosine);
    glm::dvec2 sum(0.0);
    for (unsigned i = 0; i < count; ++i) {
        const glm::vec2 u((static_cast<float>(i) + 0.5F) / static_cast<float>(count), radical_inverse(i));
        const glm::vec3 half = sample_half(out, width, u);
        const float along = glm::dot(out, half);
        const glm::vec3 in = 2.0F * along * half - out;
        if (in.z <= 0.0F || along <= 0.0F) continue;
        // D V cos divided by the density of visible normals is G2/G1 (Heitz 2018, eq. 19).
        const float weight = visibility(out, in, width) * 4.0F * in.z * out.z / masking(out, width);
        const float grazing = pow5(1.0F - along);
        sum += glm::dvec2(weight * (1.0F - grazing), weight * grazing);
    }
    return glm::vec2(sum / static_cast<double>(count));
}

glm::vec2 directional_albedo(float alpha, float cosine) {
    static const AlbedoTable table = make_table();
    const float x = std::sqrt(std::clamp(cosine, 0.0F, 1.0F)) * (table_size - 1);
    const float y = std::sqrt(std::clamp(alpha, 0.0F, 1.0F)) * (table_size - 1);
    const int column = std::min(static_cast<int>(x), table_size - 2);
    const int row = std::min(static_cast<int>(y), table_size - 2);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    const auto* entry = table.data() + row * table_size + column;
    return (entry[0] * (1.0F - fx) + entry[1] * fx) * (1.0F - fy) +
           (entry[table_size] * (1.0F - fx) + entry[table_size + 1] * fx) * fy;
}

}  // namespace bolt::shading
