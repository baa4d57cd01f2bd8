// The files themselves: budgets, the same names at every level, a contact model that is closed.
#pragma once

#include <string>

#include "tools/author/geometry/messages.hpp"
#include "tools/author/geometry/scene.hpp"

namespace bolt::geometry {

inline constexpr std::size_t near_budget = 250'000, far_budget = 60'000;  // triangles, counting instances
inline constexpr std::uintmax_t file_budget = 8'000'000;                  // bytes

void check_file_size(const std::string& path, std::string_view pointer, const Messages& messages);
void check_triangles(const Scene& scene, std::size_t budget, std::string_view pointer,
                     const Messages& messages);
void check_names(const Scene& near, const Scene& far, const Messages& messages);
void check_contact(const Scene& contact, const Scene& near, const Messages& messages);

}  // namespace bolt::geometry
