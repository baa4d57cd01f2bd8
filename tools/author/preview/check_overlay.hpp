// Draws the result of a check on the shown model: the free and blocked directions of the tool at the selected
// joint or at all joints, the tool at both ends of its free swing, and a label at each joint with a problem.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/render/overlay.hpp"
#include "engine/text/fonts.hpp"
#include "game/view/loaded_model.hpp"
#include "tools/author/pictures/room_drawing.hpp"
#include "tools/author/preview/background_check.hpp"

namespace bolt::author {

inline constexpr glm::vec4 problem_color{1.0F, 0.25F, 0.1F, 1.0F};

class CheckOverlay {
  public:
    // Replaces what is drawn. `checked`: null draws nothing. The GPU must be idle.
    void show(std::unique_ptr<CheckedAssembly> checked);
    // Releases all GPU objects; the GPU must be idle. The check's result stays.
    void release();

    // Uploads what add_to() draws. `selected`: id of the selected joint, or empty; `all`: draw all joints.
    // `model`: the shown one.
    Status prepare(gpu::Device& device, const view::LoadedModel& model, const std::string& selected,
                   bool all);

    // Adds what prepare() was last called for. `eye` and `picture` (px) place the labels.
    void add_to(render::Scene& scene, const render::Eye& eye, const glm::vec2& picture);

    // The joint whose label of the last picture is at a pixel (y down); empty: no label.
    [[nodiscard]] std::string joint_of_label(const glm::vec2& at) const;

    [[nodiscard]] const CheckedAssembly* checked() const { return checked_.get(); }
    [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
    // The room of a joint for the first of its tools that does not fit, or else for its usual one; null if
    // none was measured.
    [[nodiscard]] const geometry::DrawnToolRoom* room_of(const std::string& joint) const;
    // The free swing and the notes of a joint; empty without a measured room.
    [[nodiscard]] std::string description_of(const std::string& joint) const;

  private:
    struct DrawnFan {
        assets::Model model;
        render::GpuModel gpu;
    };
    struct UploadedTool {
        DrawnTool tool;
        render::GpuModel gpu;
    };
    struct LabelPlace {
        std::string joint;
        render::Rectangle box;  // px, y down
    };
    Status upload_selected(gpu::Device& device, const geometry::DrawnToolRoom& room);
    Status upload_small_fan(gpu::Device& device, const geometry::DrawnToolRoom& room);
    void add_tool(render::Scene& scene, const geometry::DrawnToolRoom& room) const;
    void find_nodes(const view::LoadedModel& model);
    void mark_problems(render::Scene& scene) const;
    [[nodiscard]] const std::string& id_of(const geometry::DrawnToolRoom& room) const;

    std::unique_ptr<CheckedAssembly> checked_;
    std::vector<Problem> problems_;
    std::optional<text::Fonts> fonts_;             // loaded with the first label
    std::map<std::size_t, std::set<int>> marked_;  // nodes of the joints with a problem, by Problem::joint
    std::set<int> obstructions_;                   // nodes of the part in the way onto the selected joint
    std::string selected_;
    bool all_ = false;
    // By DrawnToolRoom::joint; `fans_` for the selected joint, `small_fans_` for the others.
    std::map<std::size_t, DrawnFan> fans_, small_fans_;
    std::map<std::size_t, UploadedTool> tools_;  // by DrawnToolRoom::tool
    std::vector<LabelPlace> labels_;
};

}  // namespace bolt::author
