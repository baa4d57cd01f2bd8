// Accessors unpacked: any component type, stride and offset, normalised or not, sparse or not, into floats or
// unsigned integers. Every byte that is read was checked to be there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

// Every buffer view lies in its buffer, every accessor in its view; types and counts make sense.
Status check_views(const Document& document);
Status check_accessors(const Document& document);

// Which component types a use of an accessor admits as numbers.
enum class Numbers : std::uint8_t {
    real,       // float
    unit,       // float, or integers normalised to [0, 1] or [−1, 1]
    quantized,  // any that KHR_mesh_quantization admits
};

// The elements of an accessor as floats, one component after the other, all finite; `type` as tinygltf
// numbers it (TINYGLTF_TYPE_VEC3), `pointer` is where the accessor is used.
Result<std::vector<float>> unpack_floats(Document& document, int accessor, int type, Numbers numbers,
                                         const std::string& pointer);

// The same as unsigned integers.
Result<std::vector<std::uint32_t>> unpack_integers(Document& document, int accessor, int type,
                                                   const std::string& pointer);

}  // namespace bolt::assets
