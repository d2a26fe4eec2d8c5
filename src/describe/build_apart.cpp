#include "describe/build_apart.h"

#include <deque>
#include <exception>

#include "base/threads.h"

namespace alhazen {

BuildContext with_messages(const BuildContext& context, Messages& messages) {
    // Names all members, so that one that is new does not compile until it is passed on.
    const auto& [unused, color_mode, base_folder, textures, materials, texture_use, mesh_reader, grid_reader,
                 sdfs, world_from_node, reverse_orientation, film_resolution, film_diagonal,
                 displacement_edge_scale, exposure_time, shutter_open, world_from_camera, camera_movement] =
        context;
    return {messages,
            color_mode,
            base_folder,
            textures,
            materials,
            texture_use,
            mesh_reader,
            grid_reader,
            sdfs,
            world_from_node,
            reverse_orientation,
            film_resolution,
            film_diagonal,
            displacement_edge_scale,
            exposure_time,
            shutter_open,
            world_from_camera,
            camera_movement};
}

void build_apart(std::size_t count, BuildContext& context,
                 const std::function<void(std::size_t, BuildContext&)>& build) {
    std::deque<Messages> messages(count);
    std::vector<std::exception_ptr> thrown(count);
    parallel_for(count, 1, [&](std::size_t i) {
        messages[i].lenient = context.messages.lenient;
        BuildContext own = with_messages(context, messages[i]);
        try {
            build(i, own);
        } catch (...) {
            thrown[i] = std::current_exception();
        }
    });
    for (std::size_t i = 0; i < count; ++i) {
        for (const Message& m : messages[i].list())
            if (m.kind == Message::Kind::error)
                context.messages.add_error(m.place, m.text);
            else
                context.messages.add_warning(m.place, m.text);
        if (thrown[i]) std::rethrow_exception(thrown[i]);
    }
}

} // namespace alhazen
