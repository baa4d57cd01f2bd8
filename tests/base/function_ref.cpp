#include "engine/base/function_ref.hpp"

#include <doctest/doctest.h>

#include <memory>

using namespace bolt;

namespace {

int twice(FunctionRef<int(int)> function, int x) { return function(function(x)); }

struct Scale {
    int by = 1;
    int operator()(int x) const { return by * x; }
};

}  // namespace

TEST_CASE("FunctionRef: calls lambdas with captures, const objects and function pointers") {
    int calls = 0;
    CHECK(twice([&calls](int x) { return ++calls, x + 3; }, 1) == 7);
    CHECK(calls == 2);
    const Scale scale{5};
    CHECK(twice(scale, 2) == 50);
    int (*negate)(int) = [](int x) { return -x; };
    CHECK(twice(negate, 4) == 4);
}

TEST_CASE("FunctionRef: does not copy the callable, and forwards move-only arguments") {
    Scale scale{2};
    const FunctionRef<int(int)> first(scale);
    const FunctionRef<int(int)> second = first;
    scale.by = 7;
    CHECK(first(3) == 21);
    CHECK(second(3) == 21);
    auto take = [](std::unique_ptr<int> owned) { return *owned; };
    const FunctionRef<int(std::unique_ptr<int>)> taken(take);
    CHECK(taken(std::make_unique<int>(9)) == 9);
}
