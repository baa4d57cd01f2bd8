// Small studies, and participants of them.
#pragma once

#include <doctest/doctest.h>

#include "content/format/folders.hpp"
#include "engine/base/file.hpp"
#include "game/study/participation.hpp"
#include "tests/support/folder.hpp"

namespace study_test {

// A folder with a study of two conditions, with a training, a break, a retention test, and forms at every
// time.
class StudyFolder {
  public:
    StudyFolder();
    [[nodiscard]] const std::filesystem::path& path() const { return folder_.path(); }
    [[nodiscard]] bolt::content::Study load() const;
    bolt::study::UnixClock clock() {
        return [this] { return now; };
    }
    // Reduces the plan to one condition, one lesson of one nut, and a form after it.
    void make_short() const;
    // Replaces a text in study.json.
    void edit(const std::string& from, const std::string& to) const;

    std::int64_t now = 1'790'000'000;

  private:
    bolt::test::Folder folder_;
};

// Completes the due step as a participant who gives the same answers; `lesson_time`: s of a lesson.
void do_step(bolt::study::Participation& participation, double lesson_time = 300.0);
// The ids of the steps up to the one that cannot be completed yet, or all of them.
std::vector<std::string> do_all(bolt::study::Participation& participation);

template <class T>
T required(bolt::Result<T> result) {
    if (!result) FAIL(result.error().message());
    return std::move(*result);
}

}  // namespace study_test
