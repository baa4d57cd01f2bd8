// Compares two files of the same model that different versions of OpenCASCADE or meshoptimizer wrote: the
// bytes differ, the model does not.
#pragma once

#include <filesystem>
#include <string>

namespace bolt::test {

// The first difference beyond what other versions of these libraries cause; empty: none. Nodes must have the
// same names in the same order and the same place; each mesh the same box within 0.1 mm or 1 % of its
// diagonal, the same area within 1 % and the same number of triangles within 5 %.
std::string model_difference(const std::filesystem::path& made, const std::filesystem::path& kept);

}  // namespace bolt::test
