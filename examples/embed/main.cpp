/// A small scene built in code, rendered with progress, and written: what a program that embeds Alhazen looks
/// like.
///     embed [picture.png]
#include <cstdio>

#include <alhazen/alhazen.h>

using alhazen::Pose;
using alhazen::rgb;

namespace {

// A lamp over a clay ball, a golden one and a pyramid, on a chequered floor.
alhazen::SceneModel make_scene() {
    alhazen::SceneModel scene;
    scene.camera("perspective", {{"fov", 30}}, Pose::look_at({0, 2.5, -7}, {0, 0.8, 0}));
    scene.film("rgb", {{"xresolution", 320}, {"yresolution", 240}});
    scene.integrator("path", {{"maxdepth", 5}});

    scene.color_texture(
        "tiles", "checkerboard",
        {{"tex1", rgb(.75, .75, .7)}, {"tex2", rgb(.2, .25, .3)}, {"uscale", 8}, {"vscale", 8}});
    scene.material("floor", "diffuse", {{"reflectance", alhazen::texture("tiles")}});
    scene.material("clay", "diffuse", {{"reflectance", rgb(.6, .4, .3)}});
    scene.material("gold", "conductor",
                   {{"eta", alhazen::spectrum("metal-Au-eta")},
                    {"k", alhazen::spectrum("metal-Au-k")},
                    {"roughness", 0.05}});
    scene.emitter("lamp", "diffuse", {{"L", rgb(12, 11, 10)}});

    scene.shape("sphere", {{"radius", 0.8}}, {.material = "clay", .pose = Pose::translate(-1.1, 0.8, 0.2)});
    scene.shape("sphere", {{"radius", 0.8}}, {.material = "gold", .pose = Pose::translate(1, 0.8, 0.6)});
    scene.shape("disk", {{"radius", 1.}},
                {.pose = Pose::translate(0, 5, -1) * Pose::rotate(90, {1, 0, 0}), .emitter = "lamp"});
    scene.mesh({.positions = {-6, 0, -6, 6, 0, -6, 6, 0, 6, -6, 0, 6},
                .indices = {0, 1, 2, 0, 2, 3},
                .uv = {0, 0, 1, 0, 1, 1, 0, 1}},
               {.material = "floor"});
    scene.mesh({.positions = {-.4f, 0, -1.6f, .4f, 0, -1.6f, 0, 0, -.9f, 0, .7f, -1.35f},
                .indices = {0, 1, 3, 1, 2, 3, 2, 0, 3}},
               {.material = "clay"});
    scene.light("infinite", {{"L", rgb(.15, .2, .3)}});
    return scene;
}

} // namespace

int main(int argc, char** argv) {
    const char* file = argc > 1 ? argv[1] : "embed.png";
    try {
        alhazen::RenderRequest request;
        request.spp = 32;
        request.progress = [](const alhazen::RenderProgress& progress) {
            std::printf("\r%3.0f %%", 100 * progress.fraction);
            std::fflush(stdout);
            return true; // false would stop it
        };
        alhazen::Picture picture = make_scene().render(request);
        std::printf("\n%d x %d, %d samples a pixel, %.1f s\n", picture.width(), picture.height(),
                    picture.samples(), picture.seconds());

        double sum = 0;
        for (float value : picture.pixels()) sum += value;
        std::printf("mean %.4f\n", sum / static_cast<double>(picture.pixels().size()));
        picture.write(file);
    } catch (const alhazen::InputError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
