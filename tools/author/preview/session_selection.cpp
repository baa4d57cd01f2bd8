// The selected joint, the chosen variant, and the check of the tools.
#include "tools/author/preview/preview_session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/base/result.hpp"

namespace bolt::author {

namespace {

constexpr glm::vec4 selected_color{1.0F, 0.78F, 0.1F, 1.0F};

}  // namespace

// A joint without a drawn part is not outlined.
void PreviewSession::outline_selection(bool on) {
    if (selected_)
        (void)view::outline(*gpu_->shown_model, sources_.model(), selected_->node,
                            on ? selected_color : glm::vec4(0.0F));  // alpha 0 removes the outline
    needs_redraw_ = true;
}

// `joint`: null clears the selection.
Status PreviewSession::select_joint(const SelectableJoint* joint) {
    outline_selection(false);
    selected_ = joint == nullptr ? std::nullopt : std::optional(*joint);
    outline_selection(true);
    update_title();
    BOLT_TRY(prepare_overlay());
    return selected_ ? print(selection_line(*selected_)) : Status();
}

Status PreviewSession::prepare_overlay() {
    needs_redraw_ = true;
    panel_.refresh();
    return overlay_.prepare(*gpu_->gpu_context.device, sources_.model(),
                            selected_ ? selected_->id : std::string(), all_sectors_);
}

// The GPU must be idle.
void PreviewSession::start_check() {
    overlay_.show(nullptr);
    if (!sources_.model().without_assembly) check_.start(options_.source, sources_.variant());
    update_title();
}

Status PreviewSession::poll_check() {
    if (const auto progress = check_.progress(); std::exchange(shown_progress_, progress) != progress)
        needs_redraw_ = true;
    std::unique_ptr<CheckedAssembly> checked = check_.take_result();
    if (!checked) return {};
    BOLT_TRY(gpu_->gpu_context.device->idle());
    overlay_.show(std::move(checked));
    next_problem_ = 0;
    update_title();
    const CheckedAssembly& shown = *overlay_.checked();
    (void)print_error(shown.findings.errors);
    const std::size_t joints = shown.assembly.joints.size(), problems = overlay_.problems().size();
    BOLT_TRY(print(fmt::format("checked {}{}: {} joint{}, {} problem{}\n", sources_.model().name,
                               joints_.variant.empty() ? "" : " (" + joints_.variant + ")", joints,
                               joints == 1 ? "" : "s", problems == 0 ? "no" : fmt::to_string(problems),
                               problems == 1 ? "" : "s")));
    return prepare_overlay();
}

// Shows another variant of the file, if that can be read.
Status PreviewSession::choose_variant(std::size_t index) {
    return index < joints_.variants.size() ? reload_model(sources_.level(), joints_.variants[index])
                                           : Status();
}

// Selects the joint that a problem is about and moves the camera there.
Status PreviewSession::choose_problem(std::size_t index) {
    const Problem& problem = overlay_.problems()[index];
    next_problem_ = index + 1;
    BOLT_TRY(print(problem.error.message() + "\n"));
    if (!problem.joint) return select_joint(nullptr);
    const std::string& id = overlay_.checked()->assembly.joints[*problem.joint].design.id;
    if (const geometry::DrawnToolRoom* room = overlay_.room_of(id))
        camera_.glide_to(
            joint_view(*overlay_.checked()->rooms, *room, static_cast<double>(aspect_of(window_size()))));
    return select_joint(joint_named(joints_, id));
}

// Selects the joint at a pixel of the window, or the one whose label is there.
Status PreviewSession::follow_click(const glm::dvec2& at) {
    if (const std::string labelled = overlay_.joint_of_label(glm::vec2(at)); !labelled.empty())
        return select_joint(joint_named(joints_, labelled));
    const VkExtent2D size = window_size();
    const double height = std::max(size.height, 1U);
    const glm::dvec2 from_middle = (at - 0.5 * glm::dvec2(size.width, height)) / height;
    return select_joint(joint_at(joints_, camera_.shown, {from_middle.x, -from_middle.y}));
}

// Finds the selected joint in the files that were just reloaded.
Status PreviewSession::follow_selection() {
    if (!selected_) return {};
    const SelectableJoint* joint = joint_named(joints_, selected_->id);
    if (joint == nullptr) {
        const std::string line = fmt::format("joint {} has gone and is no longer selected\n", selected_->id);
        selected_.reset();
        update_title();
        BOLT_TRY(prepare_overlay());
        return print(line);
    }
    const bool same = selection_line(*joint) == selection_line(*selected_);
    selected_ = *joint;
    outline_selection(true);
    update_title();
    return same ? Status() : print(selection_line(*joint));
}

}  // namespace bolt::author
