// The subcommands of bolt-author. Each function adds a subcommand to `app`, which stores its exit code in
// `exit_code`.
#pragma once

namespace CLI {
class App;
}

namespace bolt::author {

void add_new(CLI::App& app, int& exit_code);
void add_validate(CLI::App& app, int& exit_code);
void add_preview(CLI::App& app, int& exit_code);
void add_import_step(CLI::App& app, int& exit_code);
void add_curve(CLI::App& app, int& exit_code);
void add_torque(CLI::App& app, int& exit_code);
void add_tool(CLI::App& app, int& exit_code);
void add_tools(CLI::App& app, int& exit_code);
void add_views(CLI::App& app, int& exit_code);
void add_words(CLI::App& app, int& exit_code);

}  // namespace bolt::author
