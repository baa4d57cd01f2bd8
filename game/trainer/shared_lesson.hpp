// A lesson on projection walls that several processes show (game/view/wall_cluster.hpp): the first process
// plays it, the others draw the same scene and panel.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "game/scene/workplace.hpp"
#include "game/trainer/room_hands.hpp"
#include "game/view/panel_stream.hpp"
#include "game/view/scene_stream.hpp"
#include "game/view/window.hpp"

namespace bolt::trainer {

// The names of a lesson's models, with which every process loads them from its own content.
struct SharedModels {
    // The assembly's folder; a process without that folder loads its own assembly of the same name. An empty
    // variant or tool is the assembly's default.
    std::string assembly, variant, tool;
    hand::Side side = hand::Side::right;  // the working hand
};

// The values of a frame that the first process sends.
struct SharedFrame {
    const SharedModels* models = nullptr;  // null: there is no lesson
    std::uint32_t lesson = 0;              // number of the lesson; on a new one the others load its models
    const scene::GpuLessonModels* on_gpu = nullptr;  // the models of the scene; null: there is no lesson
    const render::Scene* scene = nullptr;            // null: there is no lesson
    Pose scene_in_room;
    std::optional<Pose> panel;       // of its centre in the room; none: the room does not show it
    double panel_point_size = 0.0;   // m per point of the panel
    std::optional<PointingRay> ray;  // of a wand
};

inline constexpr std::size_t max_scene_change = 3584;  // bytes in the state of a frame

// Writes the frames of the first process for the others.
class LessonSender {
  public:
    // The scene goes into `bulk` if it has changed by more than max_scene_change, such as when a lesson
    // starts.
    void write(cluster::MessageWriter& message, cluster::MessageWriter& bulk, const SharedFrame& frame);
    view::PanelSender panel;  // record() the panel's picture with it; write() sends that

  private:
    view::SceneSender scene_;
    std::uint32_t lesson_ = 0;                        // as the other processes have it
    const scene::GpuLessonModels* on_gpu_ = nullptr;  // of the last frame
};

// The content of the walls of the other processes.
class FollowedLesson : public view::WindowContent {
  public:
    FollowedLesson() = default;
    Status start(view::GpuContext& gpu_context) override;
    void release() override;
    Status update(const view::WindowFrame&) override { return {}; }
    // Loads the models of a new lesson.
    Status follow(cluster::MessageReader& message, cluster::MessageReader& bulk) override;
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override;
    [[nodiscard]] bool closed() const override { return false; }

  private:
    Status load(const SharedModels& models);

    view::GpuContext* gpu_ = nullptr;
    std::uint32_t lesson_ = 0;  // whose models are loaded; 0: none
    std::unique_ptr<scene::GpuLessonModels> models_;
    render::Scene scene_;
    Pose scene_in_room_;
    std::optional<Pose> panel_pose_;
    double panel_point_ = 0.0;
    view::PanelReceiver panel_;
    std::optional<PointingRay> ray_;
    std::optional<render::GpuModel> ray_model_;
};

// The scene of the menu in a room: its panel in the dark.
render::Scene empty_room();

}  // namespace bolt::trainer
