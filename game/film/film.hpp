// A lesson that was recorded, drawn: the workplace as it was at any moment, from any view.
#pragma once

#include "engine/render/renderer.hpp"

#include "content/words/words.hpp"
#include "game/scene/systems.hpp"
#include "game/session/replay.hpp"
#include "game/view/camera.hpp"
#include "game/view/pictures.hpp"

namespace bolt::film {

struct FilmOptions {
    hand::Side hand = hand::Side::right;  // that worked
    words::Words words;                   // of the figures at the wrench

    std::string view;  // of the assembly; empty: follows the work
    VkExtent2D size{1280, 720};
    std::string gpu;
    bool stereo = false;  // both eyes, side by side: twice as wide
    bool validate = false;
};

class Film {
  public:
    // Errors: no GPU, a model that cannot be drawn, a view that the assembly has not.
    static Result<std::unique_ptr<Film>> create(const session::Prepared& at, const FilmOptions& options);
    Film(const Film&) = delete;
    Film& operator=(const Film&) = delete;
    ~Film();

    // The world of the replay: whoever replays writes every tick into it (world::write_snapshot).
    [[nodiscard]] scene::World& world() { return place_.world; }

    // Draws the world as it is. `seconds`: since the picture before; the camera glides, and fingers bend,
    // meanwhile.
    Result<render::Picture> draw(const session::Moment& moment, double seconds);

    // What the validation layers said, if they were asked for.
    [[nodiscard]] Status no_messages() const;

  private:
    struct OnGpu;
    Film() = default;
    void follow(const session::Moment& moment);

    FilmOptions options_;
    content::Assembly assembly_;
    std::unique_ptr<OnGpu> on_;
    scene::Workplace place_;
    scene::Postures postures_;
    render::Scene scene_;
    view::Glide camera_;
    motion::Sight sight_;
    std::optional<std::size_t> followed_;
};

}  // namespace bolt::film
