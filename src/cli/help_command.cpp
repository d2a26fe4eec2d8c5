/// alhazen help TYPE [NAME]: the parameters of everything a scene can name.
#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/file.h"
#include "base/messages.h"
#include "cli/commands.h"
#include "cli/terminal.h"
#include "render/manual.h"

namespace alhazen {

namespace {

struct HelpOptions {
    std::string family, kind, markdown_folder;
    std::vector<std::string> commands; ///< of the program
};

void write_markdown(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::string index =
        "# Scene language reference\n\nWhat a scene can name, family by family. These pages are "
        "written by `alhazen help --markdown docs/reference` from the declarations in the code.\n\n";
    for (const FamilyInfo& family : families()) {
        write_file(folder / (family.name + ".md"), family_markdown(family));
        index += fmt::format("- [{}]({}.md): {}\n", family.name, family.name, family.about);
    }
    write_file(folder / "README.md", index);
}

int run_help(const HelpOptions& options) {
    if (!options.markdown_folder.empty()) {
        write_markdown(options.markdown_folder);
        return exit_ok;
    }
    if (options.family.empty()) {
        fmt::print(
            "alhazen help TYPE lists what there is of a type; alhazen help TYPE NAME its parameters.\n\n");
        for (const FamilyInfo& family : families()) fmt::print("  {:<18}{}\n", family.name, family.about);
        fmt::print("  {:<18}How colours are written, and the spectra that have names.\n", "spectrum");
        return exit_ok;
    }
    if (options.family == "spectrum") {
        if (!options.kind.empty())
            throw std::runtime_error("spectra have names only; alhazen help spectrum lists them all");
        fmt::print("{}", spectra_text(std::min(terminal_columns(), 100)));
        return exit_ok;
    }
    if (options.family == "texture") {
        // One word to the user, two families: numbers and colours.
        for (const char* family : {"spectrum-texture", "float-texture"})
            run_help({family, options.kind, "", {}});
        return exit_ok;
    }
    std::vector<std::string> names{"texture", "spectrum"};
    for (const FamilyInfo& family : families()) {
        names.push_back(family.name);
        if (family.name != options.family) continue;
        if (options.kind.empty()) {
            fmt::print("{}", family_text(family));
            return exit_ok;
        }
        std::vector<std::string> kinds;
        for (const KindDoc& kind : family.kinds()) {
            kinds.push_back(kind.name);
            if (kind.name != options.kind) continue;
            fmt::print("{}", kind_text(family, kind, std::min(terminal_columns(), 100)));
            return exit_ok;
        }
        throw std::runtime_error(fmt::format("unknown {} \"{}\"{}", options.family, options.kind,
                                             did_you_mean(options.kind, kinds)));
    }
    for (const std::string& command : options.commands)
        if (options.family == command)
            throw std::runtime_error(
                fmt::format("\"{0}\" is a command; alhazen {0} --help explains it", command));
    throw std::runtime_error(
        fmt::format("unknown type \"{}\"{}", options.family, did_you_mean(options.family, names)));
}

} // namespace

void add_help_command(CLI::App& app, Action& action) {
    auto options = std::make_shared<HelpOptions>();
    CLI::App* command = app.add_subcommand("help", "explain what a scene can name, and its parameters");
    command->add_option("TYPE", options->family, "integrator, camera, material, light ...");
    command->add_option("NAME", options->kind, "one of that type");
    command->add_option("--markdown", options->markdown_folder, "write the whole reference as Markdown")
        ->type_name("FOLDER");
    command->callback([options, &app, &action] {
        for (const CLI::App* other : app.get_subcommands({})) options->commands.push_back(other->get_name());
        action = [options] { return run_help(*options); };
    });
}

} // namespace alhazen
