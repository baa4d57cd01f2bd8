#include "tests/study/support.hpp"

#include "tests/support/replaced.hpp"

namespace study_test {

using namespace bolt;

namespace {

constexpr const char* plan = R"({
  "format": "boltwright study 1",
  "id": "small",
  "title": { "en": "Small", "de": "Klein" },
  "information": { "en": "Purpose.", "de": "Zweck." },
  "consent": { "en": ["One.", "Two."], "de": ["Eins.", "Zwei."] },
  "design": { "subjects": "within", "participants": 4, "lessons": 2, "break_minutes": 2 },
  "lesson": { "assembly": "first-nut" },
  "training": { "minutes": 8 },
  "conditions": [
    { "id": "a", "title": { "en": "A" } },
    { "id": "b", "title": { "en": "B" }, "lesson": { "mode": "guided" } }
  ],
  "forms": [
    { "form": "background", "when": ["before", "after_training"] },
    { "form": "paper", "when": ["after_lesson", "retention"] },
    { "form": "tlx", "when": ["after_condition", "after"] }
  ],
  "retention": { "after_days": 7 },
  "comparisons": [{ "measure": "paper.stability" }, { "measure": "tlx.workload" }, { "measure": "duration_s" }]
}
)";

}  // namespace

StudyFolder::StudyFolder() {
    std::filesystem::create_directories(folder_ / content::forms_folder_name);
    for (const char* form : {"background", "paper", "tlx"})
        std::filesystem::copy(content::content_folder() / "questionnaires" / (std::string(form) + ".json"),
                              folder_ / content::forms_folder_name);
    REQUIRE(write_file(folder_ / content::study_file_name, plan));
}

content::Study StudyFolder::load() const {
    content::LoadedStudy loaded = content::load_study(path());
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    REQUIRE(loaded.ok());
    return std::move(loaded.study);
}

void StudyFolder::edit(const std::string& from, const std::string& to) const {
    const std::filesystem::path file = path() / content::study_file_name;
    const std::string text = required(read_file(file, 1U << 20U, ErrorCode::failed));
    REQUIRE(write_file(file, test::replaced(text, from, to)));
}

void StudyFolder::make_short() const {
    edit(R"("lessons": 2, "break_minutes": 2)", R"("lessons": 1)");
    edit(R"("training": { "minutes": 8 },)", "");
    edit(R"({ "id": "a", "title": { "en": "A" } },)", "");
    edit(R"("title": { "en": "B" }, "lesson": { "mode": "guided" })",
         R"("title": { "en": "Secret B" }, "lesson": { "view_help": false })");
    edit(R"({ "form": "background", "when": ["before", "after_training"] },)", "");
    edit(R"(["after_lesson", "retention"])", R"(["after_condition"])");
    edit(R"("when": ["after_condition", "after"])", R"("when": ["after"])");
    edit(R"("retention": { "after_days": 7 },)", "");
    edit(
        R"("comparisons": [{ "measure": "paper.stability" }, { "measure": "tlx.workload" }, { "measure": "duration_s" }])",
        R"("comparisons": [])");
}

void do_step(study::Participation& participation, double lesson_time) {
    using study::StudyStepKind;
    const study::Step& step = *participation.due();
    const content::Study& study = participation.study();
    switch (step.kind) {
        case StudyStepKind::language:
            REQUIRE(participation.choose_language("de"));
            break;
        case StudyStepKind::consent:
            for (std::size_t i = 0; i < study.consent.at("de").size(); ++i) REQUIRE(participation.agree(i));
            break;
        case StudyStepKind::form:
            for (const content::QuestionnaireItem& item : study.questionnaires[step.form].items)
                REQUIRE(participation.answer(
                    item.id, content::answer_scale_of(study.questionnaires[step.form], item).high));
            break;
        case StudyStepKind::training:
        case StudyStepKind::lesson:
        case StudyStepKind::retention:
            REQUIRE(participation.begin_lesson());
            REQUIRE(participation.end_lesson({{"duration_s", lesson_time}, {"score", 90.0}}));
            return;
        default:
            break;
    }
    REQUIRE(participation.complete());
}

std::vector<std::string> do_all(study::Participation& participation) {
    std::vector<std::string> ids;
    while (participation.due() != nullptr && participation.remaining_wait() == 0.0) {
        ids.push_back(participation.due()->id);
        do_step(participation);
    }
    return ids;
}

}  // namespace study_test
