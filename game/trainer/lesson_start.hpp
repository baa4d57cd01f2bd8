// Starts a lesson from the user's choice: loads the assembly, starts the station, loads the models and begins
// the session.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "content/format/assembly.hpp"
#include "game/scene/workplace.hpp"
#include "game/station/lesson_station.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/lesson_choice.hpp"

namespace bolt::trainer {

// Starts a station for the lesson, paused. `trainee` is the wearer of the glove. Fails if a device cannot be
// opened, or if there is a glove but no trainee's name. `dialog`: reports what an arm needs before it can be
// opened, and passes on the user's permission to move it.
Result<std::unique_ptr<station_setup::LessonStation>> start_station(const content::Assembly& assembly,
                                                                    const session::LessonOptions& options,
                                                                    const Equipment& equipment,
                                                                    const std::string& trainee,
                                                                    const device::ArmDialog& dialog);

// The signature of start_station(), which tests replace.
using StationFactory = std::function<Result<std::unique_ptr<station_setup::LessonStation>>(
    const content::Assembly&, const session::LessonOptions&, const Equipment&, const std::string& trainee,
    const device::ArmDialog&)>;

// The request that start_lesson() carries out.
struct LessonRequest {
    LessonChoice choice;
    content::TraineeSettings settings;
    session::LessonOptions options;  // those that neither choice nor settings determine
    std::filesystem::path folder;    // receives session.boltwright
    StationFactory start_station;
    device::ArmDialog arm_dialog{};
    std::filesystem::path
        interrupted{};  // session of the interrupted lesson to continue; empty: there is none
};

// The data that a lesson was started with. It outlives the lesson, because the result screen shows it.
struct LessonContext {
    LessonChoice choice;
    content::Assembly assembly;  // with the targets of the effective law, as the lesson uses it
    session::LessonOptions options;
    scene::LessonModels models;
    scene::Worker worker;
};

// The result of start_lesson().
struct StartedLesson {
    LessonContext context;
    ActiveLesson active;     // with session and station; its workplace is made when the models are on the GPU
    bool continued = false;  // the interrupted lesson goes on at the point that it had reached
    std::optional<Error> why_begun_again;  // why the interrupted lesson begins again instead
};

// Creates the folder of the next session: `out` itself, or with `folder_per_lesson` a folder in it that is
// named after the time and the assembly, such as "2026-11-25_15-40-12_zq350".
Result<std::filesystem::path> make_lesson_folder(const std::filesystem::path& out, bool folder_per_lesson,
                                                 const std::string& assembly);

// Starts the requested lesson or, if the request names one, continues an interrupted lesson. If that one
// cannot be continued, begins it again (StartedLesson::why_begun_again). Fails if the assembly cannot be
// loaded, a chosen device cannot be used, a model is damaged, or the session file cannot be created. Close
// the station of an earlier lesson first, because it holds the devices.
Result<StartedLesson> start_lesson(const LessonRequest& request);

// Calls start_lesson() on a thread of its own, so that the window shows what an arm needs and takes the
// user's keys while the arm is opened.
class LessonStartThread {
  public:
    // Starts the thread. `before`: an earlier start that was given up, or null. It may still hold the
    // devices, so the thread first waits for its end.
    explicit LessonStartThread(LessonRequest request, std::unique_ptr<LessonStartThread> before = {});
    LessonStartThread(const LessonStartThread&) = delete;
    LessonStartThread& operator=(const LessonStartThread&) = delete;
    // Gives up and waits for the thread. If the arm moves by itself, that takes until it stands still.
    ~LessonStartThread();

    // The result of start_lesson(), once; none: it has not returned yet, or the result was taken.
    std::optional<Result<StartedLesson>> take();

    [[nodiscard]] device::ArmNeeds needs() const;  // of the arm that is being opened
    void permit_move();                            // the arm may move by itself in its next attempt
    void give_up();                                // the devices are released as soon as possible

  private:
    // Stores the needs of the arm for needs(). Returns false to end its preparation.
    bool store(const device::Preparation& preparation);

    std::unique_ptr<LessonStartThread> before_;
    std::shared_ptr<device::MovePermission> permission_ = std::make_shared<device::MovePermission>();
    std::atomic<bool> given_up_ = false, done_ = false;
    mutable std::mutex mutex_;
    device::Preparation preparation_;              // under the mutex
    std::optional<Result<StartedLesson>> result_;  // only the thread uses it until done_ is true
    std::jthread thread_;                          // last, so that it ends before the other members
};

// Places the hand, the wrench and the first view, once the workplace of `active` exists. `aspect`: width /
// height of the picture.
void place_trainee(ActiveLesson& active, const LessonContext& context, float aspect);

// Prepares the cues of the lesson's sounds and, if `audible`, starts the thread that plays them. Fails if
// that thread cannot be started; the lesson then runs without sound. A missing sound device is no failure
// (LiveSound::start).
Status start_sound(ActiveLesson& active, bool audible);

}  // namespace bolt::trainer
