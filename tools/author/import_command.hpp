// bolt-author import-step: a STEP file becomes the models and a draft of an assembly.
#pragma once

namespace CLI {
class App;
}

namespace bolt::author {

void add_import_step(CLI::App& app, int& exit_code);

}  // namespace bolt::author
