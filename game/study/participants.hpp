// The participants of a study's folder: participants/Pnn with a journal for each. Enrolment, withdrawal, and
// the list that the experimenter sees.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/study/progress.hpp"

namespace bolt::study {

inline constexpr const char* participants_folder_name = "participants";

struct NewParticipant {
    std::string person;      // code
    bool simulated = false;  // the answers are not a person's
    std::int64_t time = 0;   // s since 1970-01-01 UTC
};
// Makes the folder and the journal of the next participant, and returns the folder. Takes the smallest place
// that no active participant has. Fails if the person takes part already, if active participants follow
// another plan, or if people and simulated participants would be mixed. Waits while another program enrols a
// participant; fails if that takes more than three seconds.
Result<std::filesystem::path> add_participant(const content::Study& study,
                                              const std::filesystem::path& study_folder,
                                              const NewParticipant& participant);

// The folder of a participant who has begun and not withdrawn. `participant`: "P03".
Result<std::filesystem::path> find_participant(const std::filesystem::path& study_folder,
                                               const std::string& participant);

// Deletes the files that were computed from the participant's data, and everything in the folder except the
// withdrawal mark. The caller holds the lock of the journal.
Status delete_participant(const std::filesystem::path& folder, std::int64_t time);

// Deletes the data of a participant whose journal no program has open. Fails if one has. Completes an earlier
// withdrawal that was interrupted.
Status withdraw(const std::filesystem::path& study_folder, const std::string& participant, std::int64_t time);

// A participant as the experimenter sees it.
struct ParticipantState {
    std::string participant;  // "P03"
    bool withdrawn = false;
    Progress progress;
    std::vector<std::size_t> conditions;  // in the participant's order
    std::vector<Step> steps;              // none if withdrawn
    std::optional<Error> problem;         // the journal cannot be used, or a withdrawal is not complete
    std::size_t due = 0;                  // index into `steps`; steps.size(): all are done
};
// All participants of a study's folder, in the order of their numbers.
Result<std::vector<ParticipantState>> list_participants(const content::Study& study,
                                                        const std::filesystem::path& study_folder);

// An error about a participant's folder.
Error participant_error(const std::filesystem::path& folder, std::string what, std::string expected = {});

// A plan's checksum as the journal has it.
std::string checksum_text(std::uint64_t checksum);

}  // namespace bolt::study
