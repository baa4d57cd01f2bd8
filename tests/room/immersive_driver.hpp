// Delivers a trainee's hands to a trainer without a window and without a headset: as its
// immersive frames.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>

#include "game/view/pictures.hpp"
#include "tests/room/trainee_in_room.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

namespace bolt::test {

class ImmersiveDriver final : public RoomDriver {
  public:
    // `trainer.immersive` must be set in each frame.
    explicit ImmersiveDriver(HeadlessTrainer& trainer) : trainer_(trainer) {}

    void frame(const Pose& head, const xr::Hands& hands) override {
        trainer_.immersive->head = head;
        for (view::EyeGroup& group : trainer_.immersive->groups) group = two_eyes(head, group.size);
        trainer_.immersive->hands = hands;
        trainer_.frame();
    }
    [[nodiscard]] const trainer::App& app() const override { return trainer_.app(); }
    [[nodiscard]] double step() const override { return trainer_.step(); }

  private:
    HeadlessTrainer& trainer_;
};

// One frame in which the right hand points at a widget of the panel. `select`: 0 … 1 of its trigger.
inline void point_at(HeadlessTrainer& trainer, const trainer::DrawnWidget& widget, float select) {
    const Pose panel = *trainer.app().room()->panel;
    const glm::dvec2 points =
        glm::dvec2(widget.middle) / static_cast<double>(trainer::panel_scale) - 0.5 * trainer::panel_points;
    const Vec3 target = panel * Vec3(points.x * trainer::point_size, -points.y * trainer::point_size, 0.0);
    const Vec3 hand = panel * Vec3(0.1, -0.4, 0.5);
    xr::HandInput& right = trainer.immersive->hands[xr::Side::right];
    right.active = true;
    right.select = select;
    const Vec3 along = glm::normalize(target - hand);
    right.aim = xr::ReportedPose{
        {hand, glm::normalize(Quat(1.0 - along.z, glm::cross(Vec3(0.0, 0.0, -1.0), along)))}, true};
    trainer.frame();
}

// Presses a button of the panel.
inline void press_on_panel(HeadlessTrainer& trainer, words::TextKey label) {
    const auto widgets = trainer.app().drawn_widgets();
    const auto found = std::find_if(widgets.begin(), widgets.end(), [&](const trainer::DrawnWidget& widget) {
        return widget.label == label;
    });
    REQUIRE(found != widgets.end());
    const trainer::DrawnWidget button = *found;
    for (const float select : {0.0F, 0.0F, 1.0F, 1.0F, 0.0F, 0.0F}) point_at(trainer, button, select);
    trainer.frame();
}

// The size of the eyes' pictures: large if the variable BOLT_ROOM_PICTURES names a folder, to be looked at.
inline VkExtent2D eye_size() {
    return std::getenv("BOLT_ROOM_PICTURES") != nullptr ? VkExtent2D{960, 900} : VkExtent2D{160, 120};
}

// Writes the picture of both eyes into that folder.
inline void save_eyes(HeadlessTrainer& trainer, const std::string& name) {
    const char* folder = std::getenv("BOLT_ROOM_PICTURES");
    if (folder == nullptr) return;
    const render::Picture eyes[] = {trainer.room_picture(0), trainer.room_picture(1)};
    (void)view::write_picture(view::side_by_side(eyes),
                              std::filesystem::path(folder) / ("room-" + name + ".png"));
}

}  // namespace bolt::test
