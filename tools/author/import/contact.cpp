#include "tools/author/import/contact.hpp"

#include <algorithm>

namespace bolt::step_import {

namespace {

struct Side {
    std::uint32_t low, high;
    int turn;  // +1: from low to high
    friend auto operator<=>(const Side&, const Side&) = default;
};

}  // namespace

OpenEdges open_edges(const PartMesh& mesh, std::size_t most_listed) {
    std::vector<Side> sides;
    sides.reserve(3 * count_triangles(mesh));
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = face.points[triangle[k]], b = face.points[triangle[(k + 1) % 3]];
                sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
            }
    std::sort(sides.begin(), sides.end());
    OpenEdges open;
    for (std::size_t i = 0; i < sides.size();) {
        int balance = 0;
        const std::size_t first = i;
        for (; i < sides.size() && sides[i].low == sides[first].low && sides[i].high == sides[first].high;
             ++i)
            balance += sides[i].turn;
        if (balance == 0) continue;
        open.count += static_cast<std::size_t>(std::abs(balance));
        if (open.first.size() < most_listed)
            open.first.push_back(0.5 * (mesh.points[sides[first].low] + mesh.points[sides[first].high]));
    }
    return open;
}

ContactMesh contact_mesh(const PartMesh& mesh, std::string name) {
    ContactMesh contact;
    contact.mesh.name = std::move(name);
    contact.triangles = count_triangles(mesh);
    contact.open = open_edges(mesh);
    if (contact.triangles == 0) return contact;
    assets::Primitive primitive;
    std::vector<std::uint32_t> used(mesh.points.size(), 0xFFFFFFFFU);
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles)
            for (const std::uint32_t corner : triangle) {
                std::uint32_t& index = used[face.points[corner]];
                if (index == 0xFFFFFFFFU) {
                    index = static_cast<std::uint32_t>(primitive.positions.size());
                    primitive.positions.emplace_back(mesh.points[face.points[corner]]);
                }
                primitive.indices.push_back(index);
            }
    contact.mesh.primitives.push_back(std::move(primitive));
    return contact;
}

}  // namespace bolt::step_import
