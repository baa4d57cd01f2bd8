// Result<T>: a value or the Error that explains why there is none. Every boundary returns one.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "engine/base/error.hpp"

namespace bolt {

template <class T>
using Result = tl::expected<T, Error>;

using Status = Result<void>;

inline tl::unexpected<Error> fail(Error error) { return tl::unexpected<Error>(std::move(error)); }

inline tl::unexpected<Error> fail(ErrorCode code, std::string what, std::string expected = {}) {
    Error error;
    error.code = code;
    error.what = std::move(what);
    error.expected = std::move(expected);
    return fail(std::move(error));
}

}  // namespace bolt
