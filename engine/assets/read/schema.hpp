// The glTF objects and properties that the reader accepts, as a table.
#pragma once

#include <cfloat>
#include <cstdint>
#include <vector>

namespace bolt::assets {

enum class FieldType : std::uint8_t {
    boolean,
    string,
    integer,  // not negative, at most the largest int
    number,   // finite as a float
    index,    // an index into `section`
    object,
    strings,
    numbers,
    indices,
    index_map,  // an object whose values are indices
    list        // an array of objects with `schema`; without one, of index maps
};

struct Field;
using ObjectSchema = std::vector<Field>;

struct Field {
    const char* name = "";
    FieldType kind = FieldType::number;
    const char* section = "";
    const ObjectSchema* schema = nullptr;
    std::size_t length = 0;  // of an array; 0: any
    bool required = false;
    double low = -DBL_MAX, high = DBL_MAX;
};

const ObjectSchema& root_schema();

}  // namespace bolt::assets
