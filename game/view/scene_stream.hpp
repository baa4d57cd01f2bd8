// Sends the scene of each frame to other processes, which draw it for their own eyes. A message has only the
// differences from the frame before, because most parts of a lesson rest. Sender and receiver have the same
// models.
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

// Writes scenes for read_scene(), without panels, Object::node, and objects whose model is not streamed.
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

// Applies the next message to the scene of the frame before. Fails, and leaves the scene without objects and
// labels, if the message is damaged, refers to a model that `models` lacks, or has values that cannot be
// drawn.
Status read_scene(cluster::MessageReader& message, const StreamedModels& models, render::Scene& scene);

}  // namespace bolt::view
