// The glTF objects and properties that the reader uses, as a table for check_schema.
#pragma once

#include <cfloat>
#include <cstdint>
#include <vector>

namespace bolt::assets {

enum class PropertyType : std::uint8_t {
    boolean,
    string,
    integer,    // not negative, at most the largest int
    number,     // finite as a float
    index,      // an index into `section`
    object,     // with `schema`
    strings,    // an array of strings
    numbers,    // an array of numbers
    indices,    // an array of indices
    index_map,  // an object whose values are indices
    list        // an array of objects with `schema`; without a schema, of index maps
};

struct Property;
using ObjectSchema = std::vector<Property>;

struct Property {
    const char* name = "";
    PropertyType type = PropertyType::number;
    const char* section = "";  // the section that indices refer to: "nodes", or a JSON pointer
    const ObjectSchema* schema = nullptr;
    std::size_t length = 0;  // of an array; 0: any
    bool required = false;
    double low = -DBL_MAX, high = DBL_MAX;  // inclusive
};

const ObjectSchema& root_schema();

}  // namespace bolt::assets
