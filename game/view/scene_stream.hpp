// Sends the scene of each frame to other processes, which draw it from other eyes: only the differences from
// the frame before, because most parts of a lesson rest. Sender and receiver have the same models.
#pragma once

#include <span>
#include <vector>

#include "engine/cluster/message.hpp"
#include "engine/render/scene.hpp"

namespace bolt::view {

// The models and the light that scenes may refer to: the same ones in the same order in all processes.
struct StreamedModels {
    std::vector<const render::GpuModel*> models;
    const render::EnvironmentLight* light = nullptr;
};

// Writes scenes for read_scene(), without their panels, Object::node, and objects of other models.
class SceneSender {
  public:
    void write(cluster::MessageWriter& message, const render::Scene& scene, const StreamedModels& models);
    // Writes the next scene whole, for receivers that have none yet.
    void restart();

  private:
    std::vector<render::Object> objects_;  // as the receivers have them
    std::vector<render::Label> labels_;
    bool whole_ = true;
};

// Changes the scene of the frame before as the next message says. Fails, and leaves the scene without objects
// and labels, if the message is damaged, refers to a model that is not there, or has values that cannot be
// drawn.
Status read_scene(cluster::MessageReader& message, const StreamedModels& models, render::Scene& scene);

}  // namespace bolt::view
