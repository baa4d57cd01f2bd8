#include "game/trainer/study_screen.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <array>

#include "game/study/study_lesson.hpp"

namespace bolt::trainer {

namespace {

constexpr float study_page_width = 700.0F;     // points
constexpr float lowest_buttons = 330.0F;       // points below the top of the page
constexpr std::size_t most_full_labels = 7;    // answers that are drawn as a list with a label each
constexpr std::size_t longest_comment = 4000;  // bytes

using words::Number;

const std::vector<std::string>& statements_of(const study::Participation& participation) {
    return participation.study().consent.at(participation.progress().language);
}

void draw_heading(const ScreenContext& context, const std::string& text) {
    ImGui::PushFont(context.heading);
    draw_wrapped(text, {1.0F, 1.0F, 1.0F, 1.0F});
    ImGui::PopFont();
    ImGui::Separator();
}

// "1:30"
std::string time_left(double seconds) {
    const auto whole = static_cast<int>(std::ceil(seconds));
    return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

// The answer that was given to an item; none: no answer yet, or the choice not to answer.
std::optional<double> given_answer(const study::Participation& participation, const std::string& item) {
    const auto& all = participation.progress().answers;
    const auto form = all.find(participation.due()->id);
    if (form == all.end()) return std::nullopt;
    const auto answer = form->second.find(item);
    return answer == form->second.end() ? std::nullopt : answer->second;
}

struct AnswerButtons {
    const content::AnswerScale& scale;
    std::vector<std::string> labels;  // two, one for each answer, or none
    std::optional<double> chosen;
};

const ImVec4 chosen_color{0.16F, 0.47F, 0.66F, 1.0F}, free_color{0.17F, 0.20F, 0.24F, 1.0F},
    pointed_color{0.26F, 0.30F, 0.35F, 1.0F};

// A button of an answer. Under the pointer it stays grey: after an answer the next item's button is there,
// and must not look chosen. The second click of a double click does not answer the next item.
bool draw_answer_button(const std::string& label, bool chosen, float width) {
    ImGui::PushStyleColor(ImGuiCol_Button, chosen ? chosen_color : free_color);
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, chosen ? chosen_color : pointed_color);
    const bool pressed = ImGui::Button(label.c_str(), {width, 0.0F});
    ImGui::PopStyleColor(2);
    const bool second_click =
        ImGui::IsMouseReleased(ImGuiMouseButton_Left) && ImGui::GetIO().MouseClickedLastCount[0] > 1;
    return pressed && !second_click;
}

double answer_at(const content::AnswerScale& scale, std::size_t index) {
    return scale.low + scale.step * static_cast<double>(index);
}

// One button a line, with its label. Returns the answer whose button was pressed.
std::optional<double> draw_answer_list(const ScreenContext& context, const AnswerButtons& answers) {
    std::optional<double> pressed;
    for (std::size_t i = 0; i < answers.labels.size(); ++i) {
        const double answer = answer_at(answers.scale, i);
        ImGui::PushID(static_cast<int>(i));
        if (draw_answer_button(answers.labels[i], answers.chosen == answer, 0.0F)) pressed = answer;
        note_widget(context, "study.item");
        ImGui::PopID();
    }
    return pressed;
}

// One row of numbers between the two labels.
std::optional<double> draw_answer_row(const ScreenContext& context, const AnswerButtons& answers) {
    std::optional<double> pressed;
    const std::size_t count = content::answer_count(answers.scale);
    const float spacing = 3.0F * context.scale;
    const float room = ImGui::GetContentRegionAvail().x;
    const float width = (room - spacing * static_cast<float>(count - 1)) / static_cast<float>(count);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {spacing, 4.0F * context.scale});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0.0F, 8.0F * context.scale});
    for (std::size_t i = 0; i < count; ++i) {
        const double answer = answer_at(answers.scale, i);
        if (i > 0) ImGui::SameLine();
        ImGui::PushID(static_cast<int>(i));
        if (draw_answer_button(fmt::format("{}", answer), answers.chosen == answer, width)) pressed = answer;
        note_widget(context, "study.item");
        ImGui::PopID();
    }
    ImGui::PopStyleVar(2);
    if (answers.labels.empty()) return pressed;
    const float half = 0.5F * room - spacing;
    const float left = ImGui::GetCursorPosX(), top = ImGui::GetCursorPosY();
    draw_wrapped(answers.labels.front(), muted_text, half);
    const ImVec2 below = ImGui::GetCursorPos();
    const std::string& high = answers.labels.back();
    const float high_width = std::min(half, ImGui::CalcTextSize(high.c_str(), nullptr, false, half).x);
    ImGui::SetCursorPos({left + room - high_width, top});
    draw_wrapped(high, muted_text, half);
    ImGui::SetCursorPos({left, std::max(below.y, ImGui::GetCursorPosY())});
    ImGui::Dummy({0.0F, 0.0F});
    return pressed;
}

}  // namespace

std::string StudyScreen::texts() const {
    const content::Study& study = participation_.study();
    std::string all = study::time_text(0);
    const auto add = [&](const std::map<std::string, std::string>& texts) {
        for (const auto& [language, text] : texts) all += text;
    };
    const auto add_labels = [&](const content::AnswerLabels& labels) {
        for (const auto& [language, texts] : labels)
            for (const std::string& text : texts) all += text;
    };
    add(study.titles);
    add(study.information);
    add_labels(study.consent);
    for (const content::Questionnaire& form : study.questionnaires) {
        add(form.titles);
        add_labels(form.answer_scale.labels);
        for (const content::QuestionnaireItem& item : form.items) {
            add(item.texts);
            add_labels(item.labels);
        }
    }
    return all;
}

bool StudyScreen::store(const Status& stored) {
    if (stored)
        error_.reset();
    else
        error_ = stored.error();
    return stored.has_value();
}

void StudyScreen::complete() { (void)store(participation_.complete()); }

StudyScreen::Pressed StudyScreen::draw_buttons(const ScreenContext& context, const PageButtons& buttons) {
    Pressed pressed = Pressed::none;
    const float width = 150.0F * context.scale, room = ImGui::GetContentRegionAvail().x;
    const float left = ImGui::GetCursorPosX();
    ImGui::Dummy({0.0F, 10.0F * context.scale});
    // On most pages the buttons are then at the same place.
    ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), lowest_buttons * context.scale));
    if (error_)
        draw_wrapped(words::format_text(context.words, "study.not_stored", {{"why", error_->message()}}),
                     warning_text);
    if (buttons.back) {
        ImGui::SetCursorPosX(left + room - 2.0F * width - 8.0F * context.scale);
        if (ImGui::Button(context.words["study.back"].c_str(), {width, 0.0F})) pressed = Pressed::back;
        note_widget(context, "study.back");
    }
    if (buttons.back)
        ImGui::SameLine(left + room - width);
    else
        ImGui::SetCursorPosX(left + room - width);
    ImGui::BeginDisabled(!buttons.enabled);
    if (ImGui::Button(context.words[buttons.forward].c_str(), {width, 0.0F})) pressed = Pressed::forward;
    ImGui::EndDisabled();
    note_widget(context, buttons.forward);
    // Below the others, so that the arrow keys reach it last.
    if (ImGui::Button(context.words["study.stop"].c_str())) stop_ = StopDialog::choice;
    note_widget(context, "study.stop");
    return pressed;
}

void StudyScreen::draw_language(const ScreenContext& context) {
    draw_heading(context, participation_.text(participation_.study().titles));
    draw_wrapped(context.words["study.language"], muted_text);
    const std::vector<std::string> readable = content::complete_languages(participation_.study());
    for (const words::Words& language : context.languages) {
        if (std::find(readable.begin(), readable.end(), language.language) == readable.end()) continue;
        if (draw_choice_button(language.name, participation_.progress().language == language.language) &&
            store(participation_.choose_language(language.language)))
            context.selected_language = language.language;
        note_widget(context, "study.language");
    }
    const bool chosen = !participation_.progress().language.empty();
    if (draw_buttons(context, {"study.next", chosen}) == Pressed::forward) complete();
}

void StudyScreen::draw_information(const ScreenContext& context) {
    draw_heading(context, participation_.text(participation_.study().titles));
    ImGui::BeginChild("##information", {0.0F, 0.55F * static_cast<float>(context.size.y)});
    const std::string& text = participation_.text(participation_.study().information);
    for (std::size_t from = 0; from <= text.size();) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        draw_wrapped(text.substr(from, end - from), {1.0F, 1.0F, 1.0F, 1.0F});
        ImGui::Spacing();
        from = end + 1;
    }
    ImGui::EndChild();
    if (draw_buttons(context, {"study.next"}) == Pressed::forward) complete();
}

void StudyScreen::draw_consent(const ScreenContext& context) {
    draw_heading(context, context.words["study.consent"]);
    draw_wrapped(context.words["study.agree_to_all"], muted_text);
    const std::vector<std::string>& statements = statements_of(participation_);
    bool all = true;
    for (std::size_t i = 0; i < statements.size(); ++i) {
        bool agreed = participation_.agreed(i);
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Checkbox("##agree", &agreed))
            (void)store(agreed ? participation_.agree(i) : participation_.take_back(i));
        note_widget(context, "study.consent");
        ImGui::SameLine();
        draw_wrapped(statements[i], {1.0F, 1.0F, 1.0F, 1.0F});
        ImGui::PopID();
        all = all && participation_.agreed(i);
    }
    if (draw_buttons(context, {"study.next", all}) == Pressed::forward) complete();
}

void StudyScreen::draw_item(const ScreenContext& context, const content::Questionnaire& form) {
    const content::QuestionnaireItem& item = form.items[item_];
    draw_wrapped(words::format_text(context.words, "study.item",
                                    {{"item", Number{static_cast<double>(item_ + 1), 0}},
                                     {"of", Number{static_cast<double>(form.items.size()), 0}}}),
                 muted_text);
    ImGui::PushFont(context.heading);
    draw_wrapped(participation_.text(item.texts), {1.0F, 1.0F, 1.0F, 1.0F});
    ImGui::PopFont();
    ImGui::Dummy({0.0F, 8.0F * context.scale});
    const AnswerButtons answers{content::answer_scale_of(form, item),
                                content::answer_labels(form, item, participation_.progress().language),
                                given_answer(participation_, item.id)};
    const std::size_t count = content::answer_count(answers.scale);
    const bool list = answers.labels.size() == count && count <= most_full_labels;
    if (const auto pressed = list ? draw_answer_list(context, answers) : draw_answer_row(context, answers))
        if (store(participation_.answer(item.id, *pressed))) ++item_;
    ImGui::Dummy({0.0F, 8.0F * context.scale});
    if (item_ >= form.items.size()) return;
    if (draw_answer_button(context.words["study.no_answer"], false, 0.0F) &&
        store(participation_.answer(item.id, std::nullopt)))
        ++item_;
    note_widget(context, "study.no_answer");
}

void StudyScreen::draw_form(const ScreenContext& context, const content::Questionnaire& form) {
    draw_heading(context, participation_.text(form.titles));
    const std::size_t answered = participation_.first_unanswered();
    item_ = std::min(item_, answered);
    if (item_ < form.items.size())
        draw_item(context, form);
    else
        draw_wrapped(context.words["study.form_done"], {1.0F, 1.0F, 1.0F, 1.0F});
    const bool done = item_ >= form.items.size();
    const Pressed pressed =
        draw_buttons(context, {"study.next", done || item_<participation_.first_unanswered(), item_> 0});
    if (pressed == Pressed::back) --item_;
    if (pressed == Pressed::forward && !done) ++item_;
    if (pressed == Pressed::forward && done) complete();
}

ScreenAction StudyScreen::draw_lesson(const ScreenContext& context, const study::Step& step) {
    const content::Study& study = participation_.study();
    const auto minutes = [](double seconds) { return Number{seconds / 60.0, 0}; };
    bool ready = true;
    if (step.kind == study::StudyStepKind::training) {
        draw_heading(context, context.words["study.training"]);
        draw_wrapped(words::format_text(context.words, "study.trained",
                                        {{"done", minutes(participation_.progress().training_seconds)},
                                         {"of", minutes(study.training->duration)}}),
                     muted_text);
    } else if (step.kind == study::StudyStepKind::retention) {
        draw_heading(context, context.words["study.retention"]);
        ready = participation_.remaining_wait() <= 0.0;
        const auto date = study::retention_due(study, participation_.progress());
        if (!ready && date)
            draw_wrapped(
                words::format_text(context.words, "study.come_again", {{"date", study::local_date(*date)}}),
                warning_text);
    } else {
        const std::size_t parts = participation_.conditions().size();
        draw_heading(context, words::format_text(context.words, "study.part",
                                                 {{"part", Number{static_cast<double>(step.part + 1), 0}},
                                                  {"of", Number{static_cast<double>(parts), 0}}}));
    }
    const bool interrupted = participation_.begun_lesson().has_value();
    if (ready)
        draw_wrapped(context.words[interrupted ? words::TextKey("study.continues") : "study.lesson"],
                     {1.0F, 1.0F, 1.0F, 1.0F});
    return draw_buttons(context, {"study.start", ready}) == Pressed::forward ? ScreenAction::start_lesson
                                                                             : ScreenAction::none;
}

void StudyScreen::draw_break(const ScreenContext& context) {
    draw_heading(context, context.words["study.break"]);
    const double wait = participation_.remaining_wait();
    if (wait > 0.0)
        draw_wrapped(words::format_text(context.words, "study.break_left", {{"time", time_left(wait)}}),
                     muted_text);
    if (draw_buttons(context, {"study.next", wait <= 0.0}) == Pressed::forward) complete();
}

void StudyScreen::draw_comment(const ScreenContext& context) {
    draw_heading(context, context.words["study.comment"]);
    std::array<char, longest_comment> buffer{};
    comment_.copy(buffer.data(), buffer.size() - 1);
    if (ImGui::InputTextMultiline("##comment", buffer.data(), buffer.size(), {-1.0F, 140.0F * context.scale}))
        comment_ = buffer.data();
    note_widget(context, "study.comment");
    if (draw_buttons(context, {"study.next"}) != Pressed::forward) return;
    if (comment_.empty() || store(participation_.comment(comment_))) complete();
}

ScreenAction StudyScreen::draw_last_pages(const ScreenContext& context, const study::Step& step) {
    const bool farewell = step.kind == study::StudyStepKind::farewell;
    draw_heading(context, participation_.text(participation_.study().titles));
    draw_wrapped(farewell ? words::format_text(context.words, "study.farewell",
                                               {{"participant", participation_.participant()}})
                          : context.words["study.end_of_visit"],
                 {1.0F, 1.0F, 1.0F, 1.0F});
    const Pressed pressed = draw_buttons(context, {farewell ? words::TextKey("study.finish") : "study.next"});
    if (pressed != Pressed::forward) return ScreenAction::none;
    complete();
    return farewell && !error_ ? ScreenAction::quit : ScreenAction::none;
}

ScreenAction StudyScreen::draw_stop_dialog(const ScreenContext& context) {
    ScreenAction action = ScreenAction::none;
    const words::Words& words = context.words;
    if (stop_ == StopDialog::withdrawn) {
        draw_wrapped(words["study.withdrawn"], {1.0F, 1.0F, 1.0F, 1.0F});
        if (draw_button(context, "study.finish")) action = ScreenAction::quit;
        return action;
    }
    const bool withdraws = stop_ == StopDialog::withdrawal;
    draw_wrapped(words[withdraws ? words::TextKey("study.withdraw_question") : "study.stop_question"],
                 {1.0F, 1.0F, 1.0F, 1.0F});
    if (error_)
        draw_wrapped(words::format_text(words, "study.not_stored", {{"why", error_->message()}}),
                     warning_text);
    ImGui::Dummy({0.0F, 8.0F * context.scale});
    if (draw_button(context, "study.continue")) stop_ = StopDialog::closed;
    if (withdraws) {
        if (draw_button(context, "study.delete") && store(participation_.withdraw()))
            stop_ = StopDialog::withdrawn;
        return action;
    }
    if (draw_button(context, "study.leave")) action = ScreenAction::quit;
    if (draw_button(context, "study.withdraw")) stop_ = StopDialog::withdrawal;
    return action;
}

ScreenAction StudyScreen::draw_step(const ScreenContext& context, const study::Step& step) {
    switch (step.kind) {
        case study::StudyStepKind::language:
            draw_language(context);
            return ScreenAction::none;
        case study::StudyStepKind::information:
            draw_information(context);
            return ScreenAction::none;
        case study::StudyStepKind::consent:
            draw_consent(context);
            return ScreenAction::none;
        case study::StudyStepKind::form:
            draw_form(context, participation_.study().questionnaires[step.form]);
            return ScreenAction::none;
        case study::StudyStepKind::training:
        case study::StudyStepKind::lesson:
        case study::StudyStepKind::retention:
            return draw_lesson(context, step);
        case study::StudyStepKind::pause:
            draw_break(context);
            return ScreenAction::none;
        case study::StudyStepKind::comment:
            draw_comment(context);
            return ScreenAction::none;
        case study::StudyStepKind::end_of_visit:
        case study::StudyStepKind::farewell:
            break;
    }
    return draw_last_pages(context, step);
}

LessonDisplay StudyScreen::due_display() const {
    const study::Step* step = participation_.due();
    if (step == nullptr || !study::is_lesson(step->kind)) return {};
    const content::StudyLesson& lesson = participation_.lesson();
    if (lesson.display == "headset") return {LessonDisplay::Kind::headset, {}};
    if (lesson.display == "walls")
        return {LessonDisplay::Kind::walls, study::display_file_of(lesson, folder_)};
    return {};
}

// The user leaves the display of the last lesson for the window, from which the next display is entered.
ScreenAction StudyScreen::draw_display(const ScreenContext& context, const LessonDisplay& shown) {
    using Kind = LessonDisplay::Kind;
    const bool leaves = shown.kind != Kind::window;
    const bool headset = (leaves ? shown : due_display()).kind == Kind::headset;
    draw_heading(context, participation_.text(participation_.study().titles));
    const words::TextKey text = leaves    ? headset ? words::TextKey("study.headset_off") : "study.walls_off"
                                : headset ? words::TextKey("study.headset_on")
                                          : "study.walls_on";
    draw_wrapped(context.words[text], {1.0F, 1.0F, 1.0F, 1.0F});
    return draw_buttons(context, {"study.next"}) == Pressed::forward ? ScreenAction::change_display
                                                                     : ScreenAction::none;
}

ScreenAction StudyScreen::draw(const ScreenContext& context, const LessonDisplay& shown) {
    begin_dialog(context, "##study", study_page_width * context.scale, 0.97F);
    ScreenAction action = ScreenAction::none;
    if (stop_ != StopDialog::closed) {
        action = draw_stop_dialog(context);
    } else if (participation_.due() == nullptr) {
        action = ScreenAction::quit;
        if (on_step_) on_step_();
    } else if (due_display() != shown) {
        action = draw_display(context, shown);
    } else {
        const study::Step step = *participation_.due();
        if (step.id != shown_step_) {
            shown_step_ = step.id;
            if (on_step_) on_step_();
            item_ = step.kind == study::StudyStepKind::form ? participation_.first_unanswered() : 0;
        }
        action = draw_step(context, step);
    }
    ImGui::End();
    return action;
}

}  // namespace bolt::trainer
