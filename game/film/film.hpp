// Draws the workplace of a replayed session, from a fixed view or following the work.
#pragma once

#include "engine/render/renderer.hpp"

#include "content/words/words.hpp"
#include "game/scene/systems.hpp"
#include "game/session/replay.hpp"
#include "game/view/camera.hpp"
#include "game/view/pictures.hpp"

namespace bolt::film {

struct FilmOptions {
    hand::Side hand = hand::Side::right;  // the working hand
    words::Words words;                   // for the label at the wrench

    std::string view;  // a named view of the assembly; empty: follows the work
    VkExtent2D size{1280, 720};
    std::string gpu;
    bool stereo = false;  // both eyes side by side, twice as wide
    bool validate = false;
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
