// Participants of the studies of support.hpp.
#pragma once

#include "tests/study/support.hpp"

namespace study_test {

using namespace bolt::study;
namespace content = bolt::content;
using bolt::Result;

inline Participation enrolled(StudyFolder& folder, const content::Study& study,
                              const std::string& person = "T-1") {
    return required(Participation::enrol(study, folder.path(), person, false, folder.clock()));
}

inline Result<Participation> resumed(StudyFolder& folder, const content::Study& study,
                                     const std::string& name, bool accept = false) {
    return Participation::resume(study, folder.path(), name, accept, folder.clock());
}

inline void do_until(Participation& participation, const std::string& id) {
    while (participation.due() != nullptr && participation.due()->id != id) do_step(participation);
    REQUIRE(participation.due() != nullptr);
}

}  // namespace study_test
