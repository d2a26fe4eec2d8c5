/// Every command in the README and the docs is run, in the order of the page. Lines that start with make are
/// checked to be targets of the Makefile (running them would build within the build).
#include <vector>

#include "tests/cli/program.h"

namespace alhazen::testing {
namespace {

std::vector<std::string> commands_of(const std::filesystem::path& page) {
    std::istringstream text(file_text(page));
    std::vector<std::string> commands;
    std::string line;
    bool in_block = false;
    while (std::getline(text, line)) {
        if (line.starts_with("```"))
            in_block = line == "```sh";
        else if (in_block && !line.empty() && !line.starts_with("#"))
            commands.push_back(line);
    }
    return commands;
}

class Docs : public ProgramTest, public ::testing::WithParamInterface<const char*> {};

TEST_P(Docs, EveryCommandWorks) {
    std::filesystem::path source(ALHAZEN_SOURCE_DIR);
    std::filesystem::create_directory_symlink(source / "scenes", path("scenes"));
    std::filesystem::create_directories(path("build/bin"));
    std::filesystem::create_symlink(ALHAZEN_PROGRAM, path("build/bin/alhazen"));
    auto commands = commands_of(source / GetParam());
    for (const std::string& command : commands) {
        std::string line = command;
        if (command.starts_with("make")) line = "make -n -C '" + source.string() + "' " + command.substr(4);
        Outcome o = shell(line);
        EXPECT_EQ(o.exit_code, 0) << command << "\n" << o.err;
    }
    if (std::string(GetParam()) == "README.md") {
        EXPECT_GE(commands.size(), 8u);
    }
}

INSTANTIATE_TEST_SUITE_P(Pages, Docs,
                         ::testing::Values("README.md", "docs/tour.md", "docs/architecture.md",
                                           "docs/contributing.md", "docs/dependencies.md",
                                           "docs/scene-language.md", "docs/performance.md",
                                           "docs/rasterisation.md"),
                         [](const auto& test) {
                             std::string name = std::filesystem::path(test.param).stem().string();
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

} // namespace
} // namespace alhazen::testing
