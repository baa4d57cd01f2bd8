// test_model_difference MADE KEPT: prints the difference of two models and exits with 1 if there is one.
#include <cstdio>

#include "tests/support/model_difference.hpp"

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::string difference = bolt::test::model_difference(argv[1], argv[2]);
    if (!difference.empty()) std::printf("%s\n", difference.c_str());
    return difference.empty() ? 0 : 1;
}
