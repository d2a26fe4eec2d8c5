/// The program: one binary with subcommands.
#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/messages.h"
#include "cli/commands.h"

int main(int argc, char** argv) {
    using namespace alhazen;
    CLI::App app("Alhazen renders pictures of three-dimensional scenes.", "alhazen");
    app.set_version_flag("--version", "Alhazen " ALHAZEN_VERSION);
    app.set_help_flag("-h,--help", "show this text");
    app.require_subcommand(1);
    app.failure_message([](const CLI::App* failed, const CLI::Error& e) {
        return "alhazen: error: " + CLI::FailureMessage::simple(failed, e);
    });
    Action action;
    add_render_command(app, action);
    add_info_command(app, action);
    add_accel_command(app, action);
    add_convert_command(app, action);
    add_diff_command(app, action);
    add_compare_command(app, action);
    add_sdf_command(app, action);
    add_help_command(app, action);
    if (argc == 1) {
        fmt::print("{}", app.help());
        return exit_ok;
    }
    std::string first = argv[1];
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
    if (!first.starts_with("-") && std::find(commands.begin(), commands.end(), first) == commands.end()) {
        fmt::print(stderr, "alhazen: error: unknown command \"{}\"{}\n", first,
                   did_you_mean(first, commands));
        return exit_bad_input;
    }
    try {
        app.parse(argc, argv);
        int code = action();
        // What could not be written (a full disk behind a pipe) must not pass for success.
        if (std::fflush(stdout) != 0 || std::ferror(stdout))
            throw std::runtime_error("cannot write to standard output");
        return code;
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? exit_ok : exit_bad_input;
    } catch (const SceneError& e) {
        fmt::print(stderr, "{}\n", e.what());
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "alhazen: error: out of memory\n");
    } catch (const std::exception& e) {
        fmt::print(stderr, "alhazen: error: {}\n", e.what());
    }
    return exit_bad_input;
}
