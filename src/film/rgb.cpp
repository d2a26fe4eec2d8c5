/// A picture in red, green and blue.
#include "film/picture_film.h"

namespace alhazen {
namespace {

struct RgbFilm final : PictureFilm {
    static void describe(Fields<RgbFilm>& f) {
        f.about("A digital camera's picture: red, green and blue for each pixel.");
        describe_picture(f);
        f.example("square", {make_integer("xresolution", 64), make_integer("yresolution", 64)});
        f.example("middle",
                  {make_array("cropwindow", ValueType::real, std::vector<float>{.25f, .75f, .25f, .75f})});
    }
};

} // namespace

Kind<Film> rgb_film() {
    return make_kind<Film, RgbFilm>("rgb");
}

} // namespace alhazen
