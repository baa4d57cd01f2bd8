#include "tools/author/geometry/check_levels.hpp"

#include <filesystem>

#include "tools/author/geometry/watertight.hpp"

namespace bolt::geometry {

namespace {

constexpr std::size_t most_names = 5;  // that are told one by one

// Names of `wanted` that `there` has not.
std::vector<std::string> missing_names(const Scene& wanted, const Scene& there) {
    std::vector<std::string> missing;
    for (const auto& [name, nodes] : wanted.by_name)
        if (!there.by_name.contains(name)) missing.push_back(name);
    return missing;
}

}  // namespace

void check_file_size(const std::string& path, std::string_view pointer, const Messages& messages) {
    std::error_code problem;
    const auto size = std::filesystem::file_size(path, problem);
    if (!problem && size > file_budget)
        messages.error(pointer, fmt::format("the file has {:.1f} MB", static_cast<double>(size) * 1e-6),
                       "expected at most 8 MB");
}

void check_triangles(const Scene& scene, std::size_t budget, std::string_view pointer,
                     const Messages& messages) {
    if (scene.triangle_count() > budget)
        messages.error(pointer, fmt::format("the model has {} triangles", scene.triangle_count()),
                       fmt::format("expected at most {}: import it with a larger deflection", budget));
}

void check_names(const Scene& near, const Scene& far, const Messages& messages) {
    const std::vector<std::string> lost = missing_names(near, far), added = missing_names(far, near);
    for (std::size_t i = 0; i < lost.size() && i < most_names; ++i) {
        const std::string meant = content::meant(lost[i], added);
        messages.error(
            "/model_far",
            fmt::format("the far level has no node {}, which the model has", content::in_quotes(lost[i])),
            meant.empty() ? "expected the same names at both levels"
                          : fmt::format("did you mean {}?", content::in_quotes(meant)));
    }
    for (std::size_t i = 0; i < added.size() && i < most_names && lost.empty(); ++i)
        messages.error(
            "/model_far",
            fmt::format("the far level has a node {}, which the model has not", content::in_quotes(added[i])),
            "expected the same names at both levels");
    if (lost.size() > most_names)
        messages.error("/model_far", fmt::format("{} nodes more are missing", lost.size() - most_names),
                       "expected the same names at both levels");
}

void check_contact(const Scene& contact, const Scene& near, const Messages& messages) {
    for (const Part& part : contact.parts) {
        const OpenEdges open = open_edges(part.triangles);
        if (open.count > 0)
            messages.error("/contact_model",
                           fmt::format("{} has {} open edges, one near {} mm", content::in_quotes(part.name),
                                       open.count, in_mm(open.first)),
                           "expected a closed surface");
        if (!near.by_name.contains(part.name)) {
            const std::string meant = content::meant(part.name, near.names());
            messages.error("/contact_model",
                           fmt::format("{} is no node of the model", content::in_quotes(part.name)),
                           meant.empty() ? "expected the model's names"
                                         : fmt::format("did you mean {}?", content::in_quotes(meant)));
        }
    }
}

}  // namespace bolt::geometry
