// The work glove that the hand wears: a knitted liner, palm and finger tips dipped in a rubbery coating, a
// ribbed cuff with a coloured hem.
#pragma once

#include <glm/vec2.hpp>

#include "tools/assets/sculpt/hand_shape.hpp"
#include "tools/assets/sculpt/textures.hpp"

namespace bolt::sculpt {

inline constexpr double cuff_begin = 9 * mm;  // z where the rib knit begins

enum GlovePart : int { knit, coat, cuff, hem, glove_parts };

// Positive where the glove was dipped.
double dipped(const HandShape& shape, const Vec3& p);
// The part at a point of the surface.
GlovePart glove_part(const HandShape& shape, const Vec3& p);

// A patch that is laid flat in one piece: a face of a box around the palm or a digit, or the round of the
// cuff.
struct Patch {
    int digit = 0;  // 1 to 4: finger, 0: thumb, 5: palm, 6: cuff
    int face = 0;   // ±x, ±y, ±z as 0 to 5
    bool operator==(const Patch&) const = default;
};
Patch patch_of(const HandShape& shape, const Vec3& p, const Vec3& normal, GlovePart part);

// Where the patch puts a point, in metres, and the direction in which its u grows, and −v.
struct Laid {
    glm::dvec2 uv{0.0};
    Vec3 along_u{0.0}, against_v{0.0};
};
Laid lay(const HandShape& shape, const Patch& patch, const Vec3& p);

// One period of the cuff's texture is a whole part of its round.
inline constexpr double cuff_round = 216 * mm;
inline constexpr double tile_length = 18 * mm;

// Light that reaches a point of the surface, and wear; multiplies the colour.
double shading(const HandShape& shape, const Vec3& p, const Vec3& normal);

// Materials 0 to glove_parts − 1 with their textures.
Status add_glove_materials(assets::Model& model);

}  // namespace bolt::sculpt
