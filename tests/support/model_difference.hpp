// Compares two files of the same model that different versions of OpenCASCADE or meshoptimizer wrote: the
// bytes differ, the model does not.
#pragma once

#include <filesystem>
#include <string>

namespace bolt::test {

// The first difference beyond what other versions of these libraries cause; empty: none. Nodes must have the
// same names in the same order and the same place; each mesh the same box within 0.1 mm or 5 % of its
// diagonal and the same area within 10 %. The number of triangles of the model may differ by a quarter,
// because versions of OpenCASCADE divide curved faces in other ways.
std::string model_difference(const std::filesystem::path& made, const std::filesystem::path& kept);

}  // namespace bolt::test
