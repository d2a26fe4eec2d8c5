/// Runs the program as a user would, and keeps what it said.
#pragma once

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace alhazen::testing {

struct Outcome {
    int exit_code = -1;
    std::string out, err;
};

inline std::string file_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

/// A folder of the test's own, gone when it ends; commands run in it.
class ProgramTest : public ::testing::Test {
  protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  fmt::format("alhazen-{}-{}-{}", info->test_suite_name(), info->name(), getpid());
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    Outcome shell(const std::string& command) {
        std::string line =
            fmt::format("cd '{}' && ( {} ) > out.txt 2> err.txt < /dev/null", folder_.string(), command);
        int status = std::system(line.c_str());
        Outcome o{WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_text(folder_ / "out.txt"),
                  file_text(folder_ / "err.txt")};
        return o;
    }
    Outcome alhazen(const std::string& arguments) {
        return shell(std::string(ALHAZEN_PROGRAM) + " " + arguments);
    }

    void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
    bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

    /// A small scene in scene.pbrt.
    void write_scene(const std::string& film = "") {
        write("scene.pbrt", R"(Integrator "path" "integer maxdepth" 3
Sampler "zsobol" "integer pixelsamples" 4
Film "rgb" "integer xresolution" 32 "integer yresolution" 24 )" +
                                film + R"(
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "string name" "front"
Identity
LookAt 0 0 5  0 0 0  0 1 0
Camera "perspective" "float fov" 40 "string name" "back"
WorldBegin
LightSource "point" "rgb I" [ 20 20 20 ] "point3 from" [ 2 3 -4 ]
LightSource "infinite" "rgb L" [ .1 .1 .1 ]
MakeNamedMaterial "Clay" "string type" "diffuse" "rgb reflectance" [ .6 .4 .3 ]
NamedMaterial "Clay"
Shape "sphere" "float radius" 1
)");
    }

  private:
    std::filesystem::path folder_;
};

} // namespace alhazen::testing
