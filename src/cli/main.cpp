/// The program: one binary with subcommands.
#include <cstdio>
#include <exception>

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
    app.failure_message(CLI::FailureMessage::simple);
    Action action;
    add_render_command(app, action);
    add_info_command(app, action);
    add_convert_command(app, action);
    add_diff_command(app, action);
    add_help_command(app, action);
    if (argc == 1) {
        fmt::print("{}", app.help());
        return exit_ok;
    }
    try {
        app.parse(argc, argv);
        return action();
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
