// Unwraps results in tests: an error fails the test with its message.
#pragma once

#include <doctest/doctest.h>

#include <utility>

#include "engine/base/result.hpp"

namespace bolt::test {

template <class T>
T need(Result<T> result) {
    if (!result) FAIL(result.error().message());
    return std::move(*result);
}

inline void need(const Status& status) {
    if (!status) FAIL(status.error().message());
}

}  // namespace bolt::test
