// The work glove of the hand: a knitted liner, palm and finger tips with a rubber coating, and a ribbed cuff
// with a coloured hem. Defines its parts, texture coordinates and materials.
#pragma once

#include <glm/vec2.hpp>

#include "tools/assets/sculpt/hand_shape.hpp"
#include "tools/assets/sculpt/textures.hpp"

namespace bolt::sculpt {

inline constexpr double cuff_begin = 9 * mm;  // z where the rib knit begins

enum GlovePart : int { knit, coat, cuff, hem, glove_parts };

// Returns a value that is positive where the glove is coated.
double coating(const HandShape& shape, const Vec3& p);
// Returns the part at a point of the surface.
GlovePart glove_part(const HandShape& shape, const Vec3& p);

// A chart of the texture: a face of a box around the palm or a digit, or the circumference of the cuff.
struct TexturePatch {
    int digit = 0;  // 1 to 4: finger, 0: thumb, 5: palm, 6: cuff
    int face = 0;   // ±x, ±y, ±z as 0 to 5
    bool operator==(const TexturePatch&) const = default;
};
TexturePatch patch_of(const HandShape& shape, const Vec3& p, const Vec3& normal, GlovePart part);

// A point in the texture coordinates of a patch (m), and the directions of +u and −v in space there.
struct PatchPoint {
    glm::dvec2 uv{0.0};
    Vec3 along_u{0.0}, against_v{0.0};
};
PatchPoint map_to_patch(const HandShape& shape, const TexturePatch& patch, const Vec3& p);

// The circumference of the cuff in texture coordinates (m) is a multiple of the tile length, so that the
// texture closes.
inline constexpr double cuff_round = 216 * mm;
inline constexpr double tile_length = 18 * mm;

// Returns a factor for the colour at a point of the surface, in [0.3, 1]: ambient occlusion and wear.
double ambient_shade(const HandShape& shape, const Vec3& p, const Vec3& normal);

// Adds the materials 0 to glove_parts − 1 with their textures.
Status add_glove_materials(assets::Model& model);

}  // namespace bolt::sculpt
