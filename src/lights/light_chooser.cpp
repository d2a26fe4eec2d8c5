#include "lights/light_chooser.h"

namespace alhazen {

#define CHOOSER(name)                                                                                        \
    std::unique_ptr<LightChooser> name##_light_chooser(std::span<const Light* const> lights);
#include "lights/chooser_list.h"
#undef CHOOSER

std::unique_ptr<LightChooser> make_light_chooser(std::string_view name,
                                                 std::span<const Light* const> lights) {
#define CHOOSER(kind)                                                                                        \
    if (name == #kind) return kind##_light_chooser(lights);
#include "lights/chooser_list.h"
#undef CHOOSER
    return nullptr;
}

std::vector<std::string> light_chooser_names() {
    return {
#define CHOOSER(name) #name,
#include "lights/chooser_list.h"
#undef CHOOSER
    };
}

} // namespace alhazen
