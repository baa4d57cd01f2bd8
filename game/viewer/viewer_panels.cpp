// The panels over the picture: the bar with the time line, and the panel with the curve and the clamp forces.
#include <fmt/format.h>

#include <algorithm>

#include "game/lesson/feedback.hpp"
#include "game/viewer/viewer.hpp"

namespace bolt::viewer {

namespace {

constexpr float panel_width = 300.0F;  // points
constexpr ImU32 line_color = IM_COL32(70, 80, 90, 255), played_color = IM_COL32(70, 150, 210, 255),
                chapter_color = IM_COL32(190, 200, 210, 255), mistake_color = IM_COL32(255, 110, 90, 255),
                curve_color = IM_COL32(115, 205, 255, 255), now_color = IM_COL32(255, 200, 60, 255);
constexpr ImGuiWindowFlags panel_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                         ImGuiWindowFlags_NoTitleBar;

void draw_text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

}  // namespace

// "F1: Tighten to 72 N·m", as the lesson shows it.
std::string Viewer::step_text(const TimelineMark& chapter) const {
    if (chapter.joint < 0) return chapter.event.text;
    const std::string& id =
        recording_->start.assembly.joints[static_cast<std::size_t>(chapter.joint)].design.id;
    using lesson::StepKind;
    for (const StepKind kind :
         {StepKind::run_down, StepKind::tighten, StepKind::turn, StepKind::recheck, StepKind::loosen}) {
        if (lesson::name(kind) != chapter.event.text) continue;
        const std::string& what = options_.words[lesson::text_key(kind)];
        if (kind != StepKind::tighten)
            return words::format_text(options_.words, "hud.due", {{"joint", id}, {"what", what}});
        return words::format_text(
            options_.words, "hud.due_torque",
            {{"joint", id}, {"what", what}, {"torque", words::torque_number(chapter.event.value)}});
    }
    return id + ": " + chapter.event.text;
}

void Viewer::draw_time_line(float scale) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 22.0F * scale);
    ImGui::InvisibleButton("##time", size);
    const ImVec2 high(low.x + size.x, low.y + size.y);
    time_line_ = {glm::vec2(low.x, low.y), glm::vec2(high.x, high.y)};
    const double duration = std::max(recording_->duration(), 1e-9);
    const auto x_of = [&](double time) { return low.x + static_cast<float>(time / duration) * size.x; };
    const float pointer = ImGui::GetIO().MousePos.x;
    if (ImGui::IsItemActive()) seek(duration * static_cast<double>((pointer - low.x) / size.x));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float middle = 0.5F * (low.y + high.y), half = 3.0F * scale;
    draw.AddRectFilled({low.x, middle - half}, {high.x, middle + half}, line_color, half);
    draw.AddRectFilled({low.x, middle - half}, {x_of(time_), middle + half}, played_color, half);
    const TimelineMark* nearest = nullptr;
    for (const TimelineMark& mark : recording_->marks) {
        const float x = x_of(mark.time);
        if (mark.mistake)
            draw.AddTriangleFilled({x - 5.0F * scale, low.y}, {x + 5.0F * scale, low.y},
                                   {x, low.y + 8.0F * scale}, mistake_color);
        else
            draw.AddLine({x, middle - 2.0F * half}, {x, middle + 2.0F * half}, chapter_color, scale);
        if (std::abs(x - pointer) < 6.0F * scale && (nearest == nullptr || mark.mistake)) nearest = &mark;
    }
    draw.AddCircleFilled({x_of(time_), middle}, 7.0F * scale, now_color);
    if (ImGui::IsItemHovered() && nearest != nullptr) {
        const std::string text = nearest->explanation
                                     ? lesson::mistake_text(options_.words, *nearest->explanation)
                                 : nearest->mistake ? nearest->event.text
                                                    : step_text(*nearest);
        ImGui::SetTooltip("%.1f s  %s", nearest->time, text.c_str());
    }
}

void Viewer::draw_bar(const glm::vec2& size, float scale) {
    const words::Words& words = options_.words;
    const float height = 82.0F * scale;
    ImGui::SetNextWindowPos({0.0F, size.y - height});
    ImGui::SetNextWindowSize({size.x, height});
    ImGui::SetNextWindowBgAlpha(0.9F);
    ImGui::Begin("##bar", nullptr, panel_flags);
    if (ImGui::Button("|<")) handle_key(platform::Key::page_up);
    ImGui::SameLine();
    if (ImGui::Button((playing_ ? words["viewer.pause"] : words["viewer.play"]).c_str(),
                      {90.0F * scale, 0.0F}))
        toggle_playing();
    ImGui::SameLine();
    if (ImGui::Button(">|")) handle_key(platform::Key::page_down);
    ImGui::SameLine();
    draw_text(fmt::format("{:6.1f} / {:.1f} s", time_, recording_->duration()));
    for (const double speed : offered_speeds) {
        ImGui::SameLine();
        if (ImGui::RadioButton(fmt::format("{:g}×", speed).c_str(), speed_ == speed)) speed_ = speed;
    }
    if (const auto* chapter = recording_->chapter_at(time_); chapter != nullptr && chapter->joint >= 0) {
        ImGui::SameLine(0.0F, 24.0F * scale);
        draw_text(step_text(*chapter));
    }
    draw_time_line(scale);
    ImGui::End();
}

// Torque over the angle of the nut, as recorded, with the present moment.
void Viewer::draw_curve(float scale) {
    const world::Joint* now = joint_at_work();
    if (now == nullptr) return;
    const analysis::JointCurve& curve = recording_->data.curves[now->index];
    draw_text(fmt::format("{}   {:.1f} N·m   {:.0f}°   {:.1f} kN",
                          recording_->start.assembly.joints[now->index].design.id, now->torque,
                          to_degrees(now->angle), now->clamp / 1e3));
    const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 130.0F * scale);
    ImGui::Dummy(size);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(18, 22, 26, 255), 4.0F * scale);
    double begin = 1e300, end = -1e300, most = 1.0;
    for (const analysis::Visit& visit : curve.visits)
        for (const analysis::CurvePoint& point : visit.points) {
            if (point.stage == joint::Stage::navigation) continue;
            begin = std::min(begin, point.angle);
            end = std::max(end, point.angle);
            most = std::max(most, std::abs(point.torque));
        }
    if (!(end > begin)) return;
    const auto at = [&](double angle, double torque) {
        const double x = std::clamp((angle - begin) / (end - begin), 0.0, 1.0),
                     y = std::abs(torque) / (1.08 * most);
        return ImVec2(low.x + static_cast<float>(x) * size.x,
                      low.y + size.y * (1.0F - static_cast<float>(std::min(y, 1.0))));
    };
    for (const analysis::Visit& visit : curve.visits)
        for (std::size_t i = 1; i < visit.points.size(); ++i) {
            const analysis::CurvePoint &a = visit.points[i - 1], &b = visit.points[i];
            if (a.hold != b.hold || a.stage == joint::Stage::navigation || b.time > time_) continue;
            draw.AddLine(at(a.angle, a.torque), at(b.angle, b.torque), curve_color, 1.4F * scale);
        }
    draw.AddCircleFilled(at(now->angle, now->torque), 4.0F * scale, now_color);
    draw.AddText({low.x + 4.0F * scale, low.y + 2.0F * scale}, chapter_color,
                 fmt::format("{:.0f} N·m", 1.08 * most).c_str());
}

// A bar for the clamp force of each joint; the line is its target.
void Viewer::draw_clamps(float scale) {
    const RecordedState& state = recording_->states[recording_->index_at(time_)];
    const content::Assembly& assembly = recording_->start.assembly;
    double most = 1.0;
    std::vector<double> targets;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        targets.push_back(analysis::target_clamp(assembly, i));
        most = std::max({most, 1.25 * targets.back(), state.joints[i].clamp});
    }
    const world::Joint* at_work = joint_at_work();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const double clamp = state.joints[i].clamp;
        draw_text(assembly.joints[i].design.id);
        ImGui::SameLine(44.0F * scale);
        const ImVec2 low = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x - 60.0F * scale,
                    height = ImGui::GetTextLineHeight();
        const auto x_of = [&](double force) { return low.x + static_cast<float>(force / most) * width; };
        draw.AddRectFilled(low, {low.x + width, low.y + height}, line_color, 2.0F * scale);
        draw.AddRectFilled(low, {x_of(clamp), low.y + height},
                           at_work != nullptr && at_work->index == i ? now_color : played_color,
                           2.0F * scale);
        draw.AddLine({x_of(targets[i]), low.y}, {x_of(targets[i]), low.y + height}, chapter_color,
                     1.5F * scale);
        ImGui::Dummy({width + 4.0F * scale, height});
        ImGui::SameLine();
        draw_text(fmt::format("{:.1f} kN", clamp / 1e3));
    }
}

void Viewer::draw_saving() {
    const words::Words& words = options_.words;
    if (ImGui::Button(words["viewer.picture"].c_str(), {-1.0F, 0.0F})) picture_ = SavedPicture::requested;
    if (film_.valid()) {
        draw_text(words["viewer.making"]);
    } else if (ImGui::Button(words["viewer.film"].c_str(), {-1.0F, 0.0F})) {
        start_film();
    }
}

// In the upper left corner, because a large assembly fills the panel.
void Viewer::draw_message(float scale) {
    if (message_.empty()) return;
    ImGui::SetNextWindowPos({12.0F * scale, 12.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.82F);
    ImGui::Begin("##message", nullptr,
                 panel_flags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    draw_text(message_);
    ImGui::End();
}

void Viewer::draw_panel(const glm::vec2& size, float scale) {
    const words::Words& words = options_.words;
    const float width = panel_width * scale;
    ImGui::SetNextWindowPos({size.x - width, 0.0F});
    ImGui::SetNextWindowSize({width, size.y - 82.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.82F);
    ImGui::Begin("##panel", nullptr, panel_flags);
    if (ImGui::RadioButton(words["viewer.follow"].c_str(), follows_)) handle_key(platform::Key::f);
    for (std::size_t i = 0; i < models_.workpiece.views.size(); ++i) {
        const std::string& name = models_.workpiece.views[i].name;
        if (i % 3 != 0) ImGui::SameLine();
        if (ImGui::RadioButton(name.c_str(), view_name_ == name)) show_view(i);
    }
    ImGui::Separator();
    draw_curve(scale);
    ImGui::Separator();
    draw_text(words["viewer.clamps"]);
    draw_clamps(scale);
    ImGui::Separator();
    draw_saving();
    if (recording_->mismatches > 0) ImGui::TextWrapped("%s", words["viewer.differs"].c_str());
    ImGui::End();
}

}  // namespace bolt::viewer
