#include "tools/author/preview/background_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace bolt::author {

namespace {

using namespace std::chrono_literals;

std::unique_ptr<CheckedAssembly> check(const std::string& source, const std::string& variant,
                                       geometry::CheckProgress& progress) {
    auto checked = std::make_unique<CheckedAssembly>();
    content::LoadedAssembly loaded = content::load_assembly(source, variant);
    checked->assembly = std::move(loaded.assembly);
    if (loaded.errors.empty())
        checked->findings = geometry::check_geometry(checked->assembly, &checked->rooms, &progress);
    else
        checked->findings.errors = std::move(loaded.errors);
    return checked;
}

// The number in "/joints/3/node"; none for other places.
std::optional<std::size_t> joint_in_file(std::string_view pointer) {
    constexpr std::string_view joints = "/joints/";
    if (!pointer.starts_with(joints)) return std::nullopt;
    pointer.remove_prefix(joints.size());
    std::size_t index = 0;
    const auto [end, failed] = std::from_chars(pointer.data(), pointer.data() + pointer.size(), index);
    return failed == std::errc() ? std::optional(index) : std::nullopt;
}

}  // namespace

std::vector<Problem> problems_of(const CheckedAssembly& checked) {
    std::vector<Problem> problems;
    const std::vector<content::AssemblyJoint>& joints = checked.assembly.joints;
    for (const Error& error : checked.findings.errors) {
        Problem& problem = problems.emplace_back(Problem{error, std::nullopt});
        const auto index = joint_in_file(error.pointer);
        const auto found =
            std::find_if(joints.begin(), joints.end(),
                         [&](const content::AssemblyJoint& joint) { return joint.index_in_file == index; });
        if (found != joints.end()) problem.joint = static_cast<std::size_t>(found - joints.begin());
    }
    return problems;
}

std::string problem_text(const CheckedAssembly& checked, const Problem& problem) {
    Error without_place = problem.error;
    without_place.file.clear();
    without_place.line = without_place.column = 0;
    if (!problem.joint) return without_place.message();
    without_place.pointer.clear();
    return fmt::format("{}: {}", checked.assembly.joints[*problem.joint].design.id, without_place.message());
}

BackgroundCheck::~BackgroundCheck() {
    if (is_running()) running_.progress->stop = true;
}

void BackgroundCheck::start(const std::string& source, const std::string& variant) {
    if (is_running()) {
        running_.progress->stop = true;
        stopping_.push_back(std::move(running_));
    }
    // A future waits for its thread when it is destroyed.
    std::erase_if(stopping_,
                  [](const Run& run) { return run.result.wait_for(0s) == std::future_status::ready; });
    auto progress = std::make_shared<geometry::CheckProgress>();
    running_ = {progress, std::async(std::launch::async, [source, variant, progress] {
                    return check(source, variant, *progress);
                })};
}

std::unique_ptr<CheckedAssembly> BackgroundCheck::take_result() {
    if (!is_running() || running_.result.wait_for(0s) != std::future_status::ready) return nullptr;
    return running_.result.get();
}

std::pair<std::size_t, std::size_t> BackgroundCheck::progress() const {
    if (!is_running()) return {0, 0};
    return {running_.progress->checked, running_.progress->joints};
}

}  // namespace bolt::author
