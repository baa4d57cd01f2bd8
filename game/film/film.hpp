// Draws the workplace of a replayed session, from a fixed view or following the work.
#pragma once

#include "engine/render/renderer.hpp"

#include "content/words/words.hpp"
#include "game/scene/systems.hpp"
#include "game/session/replay.hpp"
#include "game/view/camera.hpp"

namespace bolt::film {

// The workplace of a replayed session on a GPU. Destroy it before the device.
struct ReplayScene {
    std::unique_ptr<scene::GpuLessonModels> models;
    scene::Workplace workplace;
    std::vector<scene::Postures> postures;  // one for each of servo::Setup::tools
    Vec3 shoulder{0.0};                     // m, the trainee's, in the assembly's frame
    render::Scene scene;
};

// Makes the scene for the beginning of a session.
Result<ReplayScene> make_replay_scene(gpu::Device& device, const scene::LessonModels& models,
                                      const session::SessionSetup& start, hand::Side hand);

// The input of a picture besides the components in the world.
struct ReplayMoment {
    const servo::Setup& setup;
    const lesson::Lesson& lesson;
    const servo::ToolContact* contact;  // null: the session has no obstacles
    const words::Words& words;
    double seconds;  // since the previous picture, for the motion of the fingers
};

// The joint that the tool holds, else the due one.
std::optional<std::size_t> active_joint(const scene::SceneWorld& world, const lesson::Lesson& lesson);

// Call both for each picture. update_poses() moves everything to its place and fades what hides a held nut.
// collect_frame(), when the eye is known, makes the labels and fills `replay.scene` with all that is drawn.
void update_poses(ReplayScene& replay, const ReplayMoment& moment);
void collect_frame(ReplayScene& replay, const ReplayMoment& moment, const Vec3& eye);

struct FilmOptions {
    hand::Side hand = hand::Side::right;  // the working hand
    words::Words words;                   // for the label at the wrench

    std::string view;  // a named view of the assembly; empty: follows the work
    VkExtent2D size{1280, 720};
    std::string gpu;        // part of the name of the GPU to use; empty: the best
    bool stereo = false;    // both eyes side by side, twice as wide
    bool validate = false;  // under Vulkan's validation layers; see check_validation()
};

struct FilmState;

class Film {
  public:
    // Fails without a GPU, with a model that cannot be drawn, or with an unknown view.
    static Result<std::unique_ptr<Film>> create(const session::SessionSetup& start,
                                                const FilmOptions& options);
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;
    ~Film();

    // The world for session::replay().
    [[nodiscard]] scene::SceneWorld& world();

    // Draws the present world. `seconds`: time since the previous picture, for the motion of camera and
    // fingers.
    Result<render::Picture> draw(const session::ReplayTick& tick, double seconds);

    // Fails with the first message of the validation layers, if there is any.
    [[nodiscard]] Status check_validation() const;

  private:
    explicit Film(std::unique_ptr<FilmState> state);
    std::unique_ptr<FilmState> state_;
};

}  // namespace bolt::film
