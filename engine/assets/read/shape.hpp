// What a glTF object may hold, as data.
#pragma once

#include <cfloat>
#include <cstdint>
#include <vector>

namespace bolt::assets {

enum class Kind : std::uint8_t {
    boolean,
    string,
    integer,  // not negative, and no larger than an int
    number,   // finite as a float
    index,    // of an entry of `section`
    object,
    strings,
    numbers,
    indices,
    index_map,  // an object of indices
    list        // of objects of `shape`, or without one of index maps
};

struct Field;
using Shape = std::vector<Field>;

struct Field {
    const char* name = "";
    Kind kind = Kind::number;
    const char* section = "";
    const Shape* shape = nullptr;
    std::size_t length = 0;  // of an array; 0: any
    bool required = false;
    double low = -DBL_MAX, high = DBL_MAX;
};

const Shape& root_shape();

}  // namespace bolt::assets
