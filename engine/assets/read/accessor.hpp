// Unpacks accessors of any component type, stride and offset, normalised or sparse, into floats or unsigned
// integers. Every byte is bounds-checked before it is read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/assets/read/document.hpp"

namespace bolt::assets {

// Checks that every buffer view lies in its buffer, every accessor in its view, and that types and counts are
// valid.
Status check_views(const Document& document);
Status check_accessors(const Document& document);

// The component types that are allowed where an accessor is used.
enum class NumberFormats : std::uint8_t {
    real,       // float
    unit,       // float, or integers normalised to [0, 1] or [-1, 1]
    quantized,  // every type that KHR_mesh_quantization allows
};

// Returns the elements of an accessor as floats, one component after the other, all finite. `type` is
// tinygltf's number (TINYGLTF_TYPE_VEC3), `pointer` the place where the accessor is used.
Result<std::vector<float>> unpack_floats(Document& document, int accessor, int type, NumberFormats numbers,
                                         const std::string& pointer);

// The same for unsigned integers.
Result<std::vector<std::uint32_t>> unpack_integers(Document& document, int accessor, int type,
                                                   const std::string& pointer);

}  // namespace bolt::assets
