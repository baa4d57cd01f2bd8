// The subcommands of boltwright. Each function adds its subcommand to the command line; when the subcommand
// runs, it sets `exit_code`.
#pragma once

namespace CLI {
class App;
}

namespace bolt::cli {

void add_train(CLI::App& app, int& exit_code);
void add_replay(CLI::App& app, int& exit_code);
void add_report(CLI::App& app, int& exit_code);
void add_export(CLI::App& app, int& exit_code);
void add_compare(CLI::App& app, int& exit_code);
void add_render(CLI::App& app, int& exit_code);
void add_doctor(CLI::App& app, int& exit_code);
void add_glove(CLI::App& app, int& exit_code);
void add_devices(CLI::App& app, int& exit_code);

}  // namespace bolt::cli
